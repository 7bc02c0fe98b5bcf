// Where a linear loop comes to rest under constant set point and load, and what the end of a response leaves of the
// integrals of its error.
#pragma once

#include <optional>
#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

struct SteadyState {
    bool exists = false;  ///< else the rest is 0
    double y = 0, u = 0;
    /// Integral of r - y from rest at 0 to infinity; with integral action only, and not where u rests at a limit.
    std::optional<double> error_integral = {};
    bool at_limit = false;
};

/// Of the loop without limits: 0 = F x + G v + H r, v = M x + N v + R r + d. It does not exist where these equations
/// have no single solution.
SteadyState steady_state(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs);

/// The same; with integral action in closed form, from y = r and the plant's gain at rest, for runs by the thousand.
SteadyState steady_outputs(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs);

/// The integral of r - y from 0 to now, from the states x of a loop whose integral state has integrated r - y_f alone:
/// that state less the lag of the measurement filter, with that of the set-point filter. Differences of it are
/// integrals of r - y. Needs integral action.
double error_integral_in_states(const DelaySystem& system, const Filter& filter, const std::vector<double>& x);

/// Integrals of |e| and t |e| so far, by trapezoids, as a measure for what is left of them.
class ErrorTail {
public:
    /// The piece between neighbouring nodes; e = r - y.
    void add(const ResponseNode& a, const ResponseNode& b, double r);

    double absolute_error() const { return absolute_error_; }

    /// Whether less than `fraction` of the integral of t |e| is left at time t, where the error is e and its integral
    /// from there on `rest`: the tail is taken as one exponential.
    bool little_is_left(double rest, double e, double t, double fraction) const;

private:
    double absolute_error_ = 0, first_moment_ = 0, largest_ = 0;  // `largest_` is of |y|
};

}  // namespace tunewright
