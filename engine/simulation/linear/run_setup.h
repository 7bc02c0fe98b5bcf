// A run before its first step: its equations, where it ends, and what its steps are measured by.
#pragma once

#include "engine/simulation/linear/response_end.h"
#include "engine/simulation/linear/response_system.h"

namespace tunewright {

struct RunSetup {
    ResponseSystem system;
    SteadyState steady;
    double h0 = 0;       ///< the shortest step
    int level_of_L = 0;  ///< with a dead time: it is h0 2^level_of_L
    double longest = 0;  ///< step, with a dead time: an unstable plant's own modes amplify what a step gets wrong
    /// Up to this one a step is taken by its map. What an integrator's columns owe to rounding grows with the square of
    /// the step over the plant's own time, and longer ones are few.
    int last_mapped = 0;
};

/// `repeat`: the steps of an earlier run, or null.
RunSetup set_up_run(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                    const StepSchedule* repeat);

/// The largest |p| of the plant's poles, of the measurement or derivative filter and, without a dead time, of the
/// closed loop; 1/time. 0: nothing moves by itself.
double fastest_rate(const ResponseSystem& system, const LinearPlant& plant, const ParallelPid& controller);

/// The step that a run starts with: a quarter of the time 1/`fastest`, with a dead time at most an eighth of it;
/// infinite where neither limits it.
double first_step(const ResponseSystem& system, double fastest);

/// The plant's own time: its dead time plus 1/|p| of its poles except those at 0 (LinearPlant::time_scale), in the
/// plant's unit. 1 where it has neither, so that it can be divided by.
double own_time(const LinearPlant& plant);

}  // namespace tunewright
