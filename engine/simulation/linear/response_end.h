// The rest of a linear loop with constant set point and load, and the contribution of a response's tail to the
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

/// The rest of the loop without limits: 0 = F x + G v + H r, v = M x + N v + R r + d. It does not exist where these
/// equations have no single solution.
SteadyState steady_state(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs);

/// The same; with integral action in closed form, from y = r and the plant's static gain, for thousands of runs.
SteadyState steady_outputs(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs);

/// The integral of r - y from 0 to now, from the states x of a loop whose integral state has integrated only r - y_f:
/// that state, corrected by the lags of the measurement filter and the set-point filter. Differences of it are
/// integrals of r - y. Needs integral action.
double error_integral_in_states(const DelaySystem& system, const Filter& filter, const std::vector<double>& x);

/// Integrals of |e| and t |e| so far, by trapezoids, as a reference for their remaining parts.
class ErrorTail {
public:
    /// Adds the part between neighbouring nodes; e = r - y.
    void add(const ResponseNode& a, const ResponseNode& b, double r);

    double absolute_error() const { return absolute_error_; }

    /// True if less than `fraction` of the integral of t |e| remains after time t, with the error e and its remaining
    /// integral `rest` there: the tail is assumed to be one exponential.
    bool little_is_left(double rest, double e, double t, double fraction) const;

private:
    double absolute_error_ = 0, first_moment_ = 0, largest_ = 0;  // `largest_`: largest |y|
};

}  // namespace tunewright
