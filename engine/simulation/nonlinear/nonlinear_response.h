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

/// Values at equal distances from 0 to the horizon, both included; deviations from the operating point. A run that
/// ended early leaves the arrays shorter.
struct EvenSamples {
    std::vector<double> y, u;
};

struct NonlinearOptions {
    double tolerance = 1e-8;  ///< of each step, relative to the size that a state has and moves by
    double settled =
        1e-6;  ///< without a horizon: stops when y and u stay within this fraction of their largest deviation
    std::optional<double> horizon;
    int max_steps = 60000;
    std::vector<double> initial;             ///< absolute states at t = 0; empty: the steady state
    std::optional<ActuatorLimits> actuator;  ///< deviations, on top of the plant's own limits of u
    std::optional<double> delta_r;           ///< the integral of the nonlinear PID (Npid)
    int samples = 0;                         ///< with a horizon: fills `even` with that many values (0 or >= 2)
    bool nodes = true;                       ///< false: `loop.nodes` stays empty, for searches
    std::stop_token stop;                    ///< ends the run between two steps
};

struct NonlinearResponse {
    StepResponse loop;  ///< deviations from the operating point; u after the limits; `schedule` stays empty
    EvenSamples even;
    bool limited = false;  ///< u met a limit
    double t_end = 0;
    bool escaped = false;  ///< it ended early because the states left the model's domain or every bound
    std::string ended;  ///< why it ended early (the states left the model's domain, too many steps); empty: it did not
};

/// u = u_nominal + PID, then the limits with the anti-windup of limited_response.h; the load d adds to the limited u,
/// before the dead time. Before t = 0 the input is nominal, the integral starts at 0, filters at rest with the y(0) of
/// `initial` (no derivative kick from it) and r = 0.
NonlinearResponse simulate_nonlinear(const NonlinearSystem& system, const ParallelPid& controller,
                                     const StepInputs& inputs, const NonlinearOptions& options);

}  // namespace tunewright
