// The response of a loop whose actuator has limits, with anti-windup; dead time exact.
//
//   r, y --> [ controller ] -- command --> [ limits ] -- u --(+)--> [ P ] --> y
//                 ^                                 |     ^ d
//                 +------- (u - command)/Tt --------+
//
// Back-calculation (Astrom and Hagglund, Advanced PID Control, 2006, section 3.5): while the command is beyond a limit
// the integral part changes by (u - command)/Tt on top of Ki (r - y_f), so it follows what the actuator can do.
// Without integral action nothing winds up. The load is added after the limits.
//
// Method: within the limits, and at each of them, the loop is linear: exact exponential steps for each of the three,
// joined at the instants where the command crosses a limit. These are located on the cubic between nodes and refined
// with exact steps. The delayed signal is a cubic through stored values and slopes; steps end at every crossing's and
// jump's echo L, 2L, ... later until it has faded, and are longer than L afterwards, implicitly. Every step is two
// halves; it is shortened until the cubic through its ends meets the middle within the tolerance. Without dead time a
// direct term makes an algebraic loop through the limits, which is solved exactly: one piecewise linear equation,
// monotone where L(infinity) > -1. Where it is not (then the slightest dead time would make the linear loop unstable)
// the solution within the limits is taken while there is one, afterwards those at the limits.
#pragma once

#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The tracking time Tt of the anti-windup, > 0: sqrt(Ti Td) for PID, Ti for PI (the same source). For pure integral
/// action, which has no time of its own: a tenth of the plant's dead time and lags, or of 1/|Ki K| on a static plant.
/// Magnitudes of the gains count. Without integral action: infinity.
double tracking_time(const LinearPlant& plant, const ParallelPid& controller);
/// The same where the controller alone decides it; empty for pure integral action.
std::optional<double> tracking_time(const ParallelPid& controller);

/// As `simulate_linear`, with u the limited output. Differences:
/// - `y_final`, `u_final`: the steady state if the limits admit it; the plant's rest at the nearer limit if they do not
///   and the plant has one; else the last values.
/// - `settles` is false where the response leaves 1e6 times its scale (an unstable or integrating plant that the
/// limited
///   actuator cannot hold; it ends there) and where it oscillates until `max_steps`.
/// - `error_integral_final` only where y settles at r by integral action.
/// - `options.repeat` is not used and `schedule` stays empty; with a horizon the last node lies exactly on it.
/// The loop must be well posed (Loop::make); it need not be stable. All values are finite.
StepResponse simulate_limited(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                              const ActuatorLimits& limits, const ResponseOptions& options);

}  // namespace tunewright
