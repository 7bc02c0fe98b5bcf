// A recorded hour of a loop, run once more with other settings.
//
// The plant is linear, y = P u + d, and d (disturbances at any place, noise, the state at the first row) is whatever the
// recorded u does not explain. The same d with another u gives
//
//     y_new = y + P (u_new - u),    u_new = C(r, y_new),
//
// in which d and the plant's state at the start need not be known: both drop out of the difference. With the settings of
// the record the replay is the record itself, whatever the model; the nearer the settings, the less the model counts.
#pragma once

#include <vector>

#include "engine/controller/sampled/pid_program.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// Rows of equal spacing; u[k] holds from row k until row k + 1. Equal lengths, at least 2 rows, finite numbers.
struct LoopRows {
    double t0 = 0;  ///< time of the first row
    double h = 0;   ///< > 0, time between rows
    std::vector<double> u, y, r;

    std::size_t size() const { return y.size(); }
};

/// y and u at the rows of the record. `escaped`: y left kMaxEscape of the record's range; rows from there on are missing.
struct ReplayedRows {
    std::vector<double> u, y;
    bool escaped = false;
};

/// The controller takes over from the record's u at the first row without a bump, and computes every law.Ts; where that
/// is less than h several times a row, with y on straight lines between rows, and where it is more at the first row at
/// or after its time. The plant takes u_new as it takes the recorded u: held from row to row, the dead time exact.
/// `limits.output` are values of u itself, no deviations.
ReplayedRows replay(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits, const LoopRows& record);

}  // namespace tunewright
