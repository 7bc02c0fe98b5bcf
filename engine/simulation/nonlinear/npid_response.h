// The response of a loop with the nonlinear PID to constant set point and load from t = 0, dead time exact.
//
// The loop is the linear one with phi(e) - e added to its integral's input. Within a step that is a cubic through
// values and slopes, like the delayed signal: known for steps up to the dead time (y does not depend on it there),
// found by repetition for longer ones and without dead time.
#pragma once

#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// As `simulate_linear`, for the gains of the linear part (b 1, c 0, no filter of the measurement), delta_r > 0. The
/// step size matters: the response is not proportional to it. Differences:
/// - `error_integral_final` is the integral so far plus what the integral's state has yet to change: exact up to the
///   third power of the error at the last node.
/// - `settles` is false also where the response grows without bound; it ends there.
/// The linear part's loop must be well posed; it need not be stable.
StepResponse simulate_npid(const LinearPlant& plant, const ParallelPid& linear_part, double delta_r,
                           const StepInputs& inputs, const ResponseOptions& options);

}  // namespace tunewright
