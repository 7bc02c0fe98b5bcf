// The setup of a run before its first step: its equations, its end, and the reference of its step lengths.
#pragma once

#include "engine/simulation/linear/response_end.h"
#include "engine/simulation/linear/response_system.h"

namespace tunewright {

struct RunSetup {
    ResponseSystem system;
    SteadyState steady;
    double h0 = 0;       ///< the shortest step
    int level_of_L = 0;  ///< with a dead time: it is h0 2^level_of_L
    double longest = 0;  ///< longest step, with a dead time: an unstable plant's own modes amplify a step's error
    /// Longest step that is taken by its map. The rounding error of an integrator's columns grows with the square of
    /// the step over the plant's own time; longer steps are rare.
    int last_mapped = 0;
};

/// `repeat`: the steps of an earlier run, or null.
RunSetup set_up_run(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                    const StepSchedule* repeat);

/// The largest |p| of the plant's poles, of the measurement or derivative filter and, without a dead time, of the
/// closed loop; 1/time. 0 if there is no such pole.
double fastest_rate(const ResponseSystem& system, const LinearPlant& plant, const ParallelPid& controller);

/// The first step of a run: a quarter of the time 1/`fastest`, with a dead time at most an eighth of it; infinite if
/// there is neither.
double first_step(const ResponseSystem& system, double fastest);

/// The plant's own time: its dead time plus 1/|p| of its poles except those at 0 (LinearPlant::time_scale), in the
/// plant's unit. 1 if it has neither, so that it is a valid divisor.
double own_time(const LinearPlant& plant);

}  // namespace tunewright
