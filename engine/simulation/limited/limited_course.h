// A loop with actuator limits whose inputs change while it runs, as states of the loop itself. limited_response.cpp has
// the run.
#pragma once

#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/linear/response_end.h"

namespace tunewright {

/// A jump of one state of a loop; t >= 0.
struct StateJump {
    double t = 0;
    int state = 0;
    double change = 0;
};

/// A loop whose inputs are states of its own (course/course.h): at rest at 0 until they jump.
struct LimitedCourse {
    DelaySystem system;
    std::vector<StateJump> jumps;  ///< in ascending t
    SteadyState rest;              ///< after the last of them, within the limits
    StepInputs largest;            ///< the sizes of the inputs
};

/// As simulate_limited, for such a loop; without a horizon it ends at rest after the last jump. `error_integral` of the
/// nodes is that of -y, and `error_integral_final` is empty.
StepResponse simulate_limited_course(const LinearPlant& plant, const ParallelPid& controller,
                                     const LimitedCourse& course, const ActuatorLimits& limits,
                                     const ResponseOptions& options);

}  // namespace tunewright
