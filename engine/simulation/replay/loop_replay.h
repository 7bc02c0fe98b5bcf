// A recorded run of a loop, repeated with other settings.
//
// The plant is linear, y = P u + d, where d (disturbances at any place, noise, the state at the first row) is the part
// of y that the recorded u does not explain. The same d with another u gives
//
//     y_new = y + P (u_new - u),    u_new = C(r, y_new),
//
// so neither d nor the state of the plant at the start has to be known: both cancel. With the settings of the record
// the replay is the record itself for any model, and the error of the model counts more the further the settings are
// away.
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

/// y and u at the rows of the record. `escaped`: y moved away from the recorded one by 1000 times the range of the
/// record; the rows from there on are missing.
struct ReplayedRows {
    std::vector<double> u, y;
    bool escaped = false;
};

/// The controller takes over from the record's u at the first row without a bump and computes every law.Ts: if that is
/// less than h, several times per row, with y on straight lines between rows; if it is more, at the first row at or
/// after each multiple. The plant receives u_new as the recorded u: held from row to row, with the exact dead time.
/// `limits.output` are values of u itself, not deviations.
ReplayedRows replay(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                    const LoopRows& record);

}  // namespace tunewright
