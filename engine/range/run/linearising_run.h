// A step across the range under the input/output linearising controller that knows the equations and their states: how
// well any controller could pass, for the schedule to be seen beside (simulation/nonlinear/linearising_response.h).
#pragma once

#include "engine/range/run/scheduled_run.h"

namespace tunewright::range {

/// (tau s/r + 1)^r is what it makes of the loop, r the relative degree.
struct LinearisingPassage {
    ScheduledRun run;  ///< without Kp; `at` is y
    double tau = 0;
};

/// From rest at the first value of a profile of one step, over y. tau: the largest Ti/(K Kp) of the rows with the gain
/// of the plant there, which is the loop's own with a well tuned PI: the controller is as fast as the schedule where
/// that is slowest. Errors: unsupported where there is no such controller (a parameter moves, no one step, no relative
/// degree, unstable zero dynamics), its sentence says which; those of SteadyBranch::at.
Expected<LinearisingPassage> run_linearising(const SteadyBranch& branch, const Schedule& schedule,
                                             const Profile& profile, const RunOptions& options);

}  // namespace tunewright::range
