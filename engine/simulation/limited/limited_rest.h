// Where a loop with limits on its input comes to rest, and how large its output may become.
#pragma once

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/limited/limited_loop.h"
#include "engine/simulation/linear/steady_state.h"

namespace tunewright {

/// Where the loop comes to rest, limits respected; nowhere where a limit holds an integrating or unstable plant.
struct LimitedRest {
    bool exists = false, within = false;  // within: by the control law, not at a limit
    double y = 0, u = 0;
    SteadyState linear;
};

LimitedRest find_rest(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                      const ActuatorLimits& limits);

/// The size that y has when the actuator does all it can over the plant's own time, > 0.
double scale_of_y(const LinearPlant& plant, const StepInputs& in, const ActuatorLimits& limits, double y_rest);

}  // namespace tunewright
