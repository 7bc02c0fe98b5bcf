// A PID loop on a nonlinear plant from t = 0: set-point and load steps, input limits, dead time.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/limited/limited_response.h"

namespace tunewright {

/// Values at equal distances from 0 to the horizon, both included; deviations from the operating point. After an early
/// end the arrays are shorter.
struct EvenSamples {
    std::vector<double> y, u;
};

struct NonlinearOptions {
    double tolerance = 1e-8;  ///< error of each step, relative to the size and movement of a state
    double settled =
        1e-6;  ///< without a horizon: stops when y and u stay within this fraction of their largest deviation
    std::optional<double> horizon;
    int max_steps = 60000;
    std::vector<double> initial;             ///< absolute states at t = 0; empty: the steady state
    std::optional<ActuatorLimits> actuator;  ///< deviations, in addition to the plant's own limits of u
    std::optional<double> delta_r;           ///< for the integral of the nonlinear PID (Npid)
    int samples = 0;                         ///< with a horizon: number of values in `even` (0 or >= 2)
    bool nodes = true;                       ///< false: `loop.nodes` stays empty, for searches
    std::stop_token stop;                    ///< ends the run between two steps
};

struct NonlinearResponse {
    StepResponse loop;  ///< deviations from the operating point; u after the limits; `schedule` stays empty
    EvenSamples even;
    bool limited = false;  ///< u reached a limit
    double t_end = 0;
    bool escaped = false;  ///< early end because the states left the model's domain or are unbounded
    std::string ended;     ///< the reason for an early end (the states left the model's domain, too many steps); empty:
                           ///< none
};

/// u = u_nominal + PID, then the limits with the anti-windup of limited_response.h; the load d adds to the limited u,
/// before the dead time. Before t = 0 the input is nominal and r = 0; the integral starts at 0, and the filters are at
/// rest with the y(0) of `initial`, so that it causes no derivative kick.
NonlinearResponse simulate_nonlinear(const NonlinearSystem& system, const ParallelPid& controller,
                                     const StepInputs& inputs, const NonlinearOptions& options);

}  // namespace tunewright
