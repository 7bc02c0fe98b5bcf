// The plant behind a valve that sticks, from a record of its cycle.
#pragma once

#include <span>
#include <vector>

#include "engine/check/valve/valve_loop.h"
#include "engine/check/valve/valve_model.h"

namespace tunewright::check {

struct ValvePlantFit {
    ValveModel valve;
    RowPlant plant;
    double square = 0;  ///< of the residual, over that of the measurement
};

/// For each valve about as wide as `band` and each lag of a grid the first-order plant with dead time whose response to
/// the valve's position is nearest to the measurement, by least squares over a grid of delays, the best first.
/// What is slower than the cycle, such as a drifting load, is left out of both.
/// `period` and `longest_lag` in rows; `sign`: that of the plant's gain. Empty: the record is shorter than some
/// periods.
std::vector<ValvePlantFit> fit_valve_plants(std::span<const double> output, std::span<const double> measurement,
                                            double band, double period, double longest_lag, double sign);

/// The series without its mean over one period about each row.
std::vector<double> without_drift(std::span<const double> values, double period);

}  // namespace tunewright::check
