// The steady state of a nonlinear plant near a given point.
#pragma once

#include <span>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// f(x, u_nominal) = 0 by Newton's method from `start`: scaled by the states' sizes, least-norm steps where the
/// Jacobian is singular (an integrating tank keeps the level that was given), damped until the rates fall. Accepted
/// where Newton's step has come down to rounding, the rates are 0 to 1e-10 of their terms, and no state has left the
/// factor of two around its start (a state given as 0: the distance 1).
/// Errors, invalid_argument: not finite on the start or the way (names the operation); none near (says how far it got).
Expected<std::vector<double>> steady_state_near(const NonlinearSystem& system, std::span<const double> start);

}  // namespace tunewright
