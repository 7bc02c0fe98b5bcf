// The response of a linear loop to constant set point and load from t = 0, dead time exact.
//
// Method of steps: within a step the delayed signal is a cubic through stored values and slopes (order 4), everything
// else is exact. Steps are h0 2^k: short after every jump and its echoes at L, 2L, ..., longer where midpoint values
// show that a cubic through the outer points would do; beyond the echoes also longer than L, then with the new values
// found implicitly. Without dead time the steps are exact whatever their length.
#pragma once

#include <optional>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// One instant. Two nodes of equal t are the values before and after a jump.
struct ResponseNode {
    double t = 0;
    double y = 0, y_slope = 0;
    double u = 0, u_slope = 0;
    double error_integral = 0;  ///< integral of r - y from 0 to t
};

struct StepInputs {
    double r = 0;  ///< set point from t = 0
    double d = 0;  ///< load at the plant input from t = 0
};

/// The step lengths of a run, to repeat it with slightly different parameters on the same instants.
struct StepSchedule {
    double h0 = 0;
    std::vector<signed char> level;
    int to_horizon = 0;  ///< after these, as many equal steps up to the horizon
};

/// The same instants and those halfway between them.
StepSchedule halved(const StepSchedule& schedule);

struct ResponseOptions {
    double tolerance = 1e-6;        ///< of the interpolation, relative to the local deviation from the final value
    double settled = 1e-6;          ///< stops when y and u stay within this fraction of their largest deviation
    std::optional<double> tail;     ///< and not before less than this fraction of the integral of t |e| is left
    std::optional<double> horizon;  ///< stops exactly here instead
    int max_steps = 60000;          ///< counts only where the run chooses its steps itself
    const StepSchedule* repeat = nullptr;
};

struct StepResponse {
    std::vector<ResponseNode> nodes;
    double y_final = 0, u_final = 0;             ///< steady state
    std::optional<double> error_integral_final;  ///< integral of r - y to infinity, exact; with integral action only
    bool settles = true;                         ///< the stopping rule was met before max_steps
    StepSchedule schedule;
};

/// The loop must be stable and well posed (Loop::make, count_unstable_poles).
StepResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                             const ResponseOptions& options);

}  // namespace tunewright
