// Whether the measurement follows the output only through a dead band, where too few turns of the output are recorded
// for fit_valve(): the output through each valve and a lag, or an integral, is compared with the whole measurement,
// without the measurement's own past.
#pragma once

#include <optional>
#include <span>

#include "engine/check/valve/valve_fit.h"

namespace tunewright::check {

struct HysteresisFit {
    double gain = 0;               ///< ln of the residual's square, without over with a valve
    double explained = 0;          ///< share of the measurement's variance with the valve, 0 to 1
    double explained_without = 0;  ///< by the output alone, or by the set point
    double band = 0, jump = 0;     ///< u
    double plant_gain = 0;         ///< sign and size of the fitted gain
    double ratio = 0;              ///< of the band to the output's range
    int turns = 0;                 ///< of the output by more than half the band
};

/// `period`: rows of the record. A measurement that follows the set point needs no valve to be explained; `set_point`
/// is empty if it is unknown. Empty without candidates.
std::optional<HysteresisFit> fit_hysteresis(std::span<const double> measurement, std::span<const double> set_point,
                                            const ValveBank& bank, double period);

}  // namespace tunewright::check
