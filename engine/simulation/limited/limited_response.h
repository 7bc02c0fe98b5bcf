// The response of a loop whose actuator has limits, with anti-windup; dead time exact.
//
//   r, y --> [ controller ] -- command --> [ limits ] -- u --(+)--> [ P ] --> y
//                 ^                                 |     ^ d
//                 +------- (u - command)/Tt --------+
//
// Back-calculation (Åström and Hägglund, Advanced PID Control, 2006, section 3.5): while the command is beyond a limit
// the integral part changes by (u - command)/Tt on top of Ki (r - y_f), so it follows the actuator. Without integral
// action nothing winds up. The load is added after the limits.
//
// Method: within the limits, and at each of them, the loop is linear: exact exponential steps for each of the three,
// joined at the instants where the command crosses a limit. These are located on the cubic between nodes and refined
// with exact steps. The delayed signal is a cubic through stored values and slopes. Steps end at the echoes of every
// crossing and jump, L, 2L, ... later, until they have faded; afterwards steps may be longer than L and are implicit.
// Every step has two halves; it is shortened until the cubic through its ends agrees with the midpoint within the
// tolerance. Without dead time a direct term makes an algebraic loop through the limits, which is solved exactly: one
// piecewise linear equation, monotone if L(infinity) > -1. If it is not monotone (then the smallest dead time would
// make the linear loop unstable), the solution within the limits is used while there is one, afterwards those at the
// limits.
#pragma once

#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The tracking time Tt of the anti-windup, > 0: sqrt(Ti Td) for PID, Ti for PI (the same source). For pure integral
/// action, which has no such time: a tenth of the plant's dead time and lags, or of 1/|Ki K| on a static plant.
/// Magnitudes of the gains count. Without integral action: infinity.
double tracking_time(const LinearPlant& plant, const ParallelPid& controller);
/// The same if the controller alone determines it; empty for pure integral action.
std::optional<double> tracking_time(const ParallelPid& controller);

/// As `simulate_linear`, with u the limited output. Differences:
/// - `y_final`, `u_final`: the steady state if the limits allow it; otherwise the plant's rest at the nearer limit
///   if the plant has one; else the last values.
/// - `settles` is false if the response exceeds 1e6 times its scale (an unstable or integrating plant that the limited
///   actuator cannot hold; it ends there), and if it oscillates until `max_steps`.
/// - `error_integral_final` exists only if y settles at r by integral action.
/// - `options.repeat` is not used and `schedule` stays empty; with a horizon the last node lies exactly on it.
/// The loop must be well posed (Loop::make); it need not be stable. All values are finite.
StepResponse simulate_limited(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                              const ActuatorLimits& limits, const ResponseOptions& options);

}  // namespace tunewright
