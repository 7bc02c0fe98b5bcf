// The response of a loop on a linear plant to constant set point and load from t = 0, dead time exact; the controller
// is a PID or the nonlinear PID.
//
//   x' = F x + G v + H r,   w = u + d = M x + N v + R r + d,   y = Y x + Z v,   v(t) = w(t - L)   (loop/delay_system.h)
//
// Method of steps: within a step the delayed signal is a cubic through stored values and slopes (order 4), everything
// else is exact. Steps are h0 2^k: short after every jump and its echoes at L, 2L, ..., longer where midpoint values
// show that a cubic through the outer points is accurate enough; after the echoes also longer than L, with implicit
// steps (long_step.h). Without dead time the steps are exact whatever their length. Source of the method of steps:
// Bellman and Cooke, Differential-Difference Equations (1963), chapter 3.
//
// The nonlinear PID adds phi(e) - e to its integral's input (ErrorScaling of controller/pid.h). Within a step this is
// one more cubic: known for steps up to the dead time (y does not depend on it there), found by iteration for longer
// ones and without dead time.
//
// Units: t in the plant's time; y, r in units of y; u, d in units of u; all deviations from the operating point.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

class Propagator;

/// The signals at one time. Two nodes of equal t have the values before and after a jump.
struct ResponseNode {
    double t = 0;               ///< >= 0, ascending from node to node
    double y = 0, y_slope = 0;  ///< the plant's output and its derivative in t
    double u = 0, u_slope = 0;  ///< the controller's output, without the load
    double error_integral = 0;  ///< integral of r - y from 0 to t
};

struct StepInputs {
    double r = 0;  ///< set point from t = 0
    double d = 0;  ///< load at the plant input from t = 0
};

/// The step lengths of a run, with which it can be repeated at the same times for slightly different parameters.
struct StepSchedule {
    double h0 = 0;                   ///< > 0
    std::vector<signed char> level;  ///< level of each step: its length is h0 2^level, 0 <= level <= 60
    int to_horizon = 0;              ///< then this number of equal steps up to the horizon
    /// The run's propagator, with steps that a repetition can reuse. For one thread only.
    std::shared_ptr<Propagator> propagator = {};
};

struct ResponseOptions {
    double tolerance = 1e-6;        ///< of the interpolation, relative to the local deviation from the final value
    double settled = 1e-6;          ///< stops when y and u stay within this fraction of their largest deviation
    std::optional<double> tail;     ///< and not before less than this fraction of the integral of t |e| remains
    std::optional<double> horizon;  ///< stops exactly here instead
    int max_steps = 60000;          ///< only counts if the run chooses its steps itself
    const StepSchedule* repeat = nullptr;  ///< the steps to take until it has settled; not owned
};

struct StepResponse {
    std::vector<ResponseNode> nodes;             ///< at least one, the first at t = 0
    double y_final = 0, u_final = 0;             ///< steady state
    std::optional<double> error_integral_final;  ///< integral of r - y to infinity, exact; with integral action only
    bool settles = true;                         ///< false: `max_steps` was reached first
    StepSchedule schedule;
};

/// The loop must be stable and well posed (Loop::make, count_unstable_poles). All values are finite.
StepResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                             const ResponseOptions& options);

/// The same with the nonlinear PID: the gains of its linear part (b = 1, c = 0, no filter of the measurement) and
/// delta_r > 0 in units of y. The response is not proportional to the size of the step. Differences:
/// - `error_integral_final` is the integral so far plus the remaining change of the integral's state: exact up to the
///   third power of the error at the last node.
/// - `settles` is also false if the response grows without bound; it ends there. The linear part's loop must be well
///   posed; it need not be stable. Source: Jin and Son (2019), Eqs. 3 and 5.
StepResponse simulate_npid(const LinearPlant& plant, const ParallelPid& linear_part, double delta_r,
                           const StepInputs& inputs, const ResponseOptions& options);

}  // namespace tunewright
