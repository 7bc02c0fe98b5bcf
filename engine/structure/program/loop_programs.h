// What the controllers of a structure compute in each call, as one program: source text and simulation come from it.
//
// Each controller is that of code/algorithm.h with its rules, limits, anti-windup, manual, changes of settings and
// first call. Its variables have a name or a number of their own: inner_Kp, Kp_2. All times are in seconds. Errors:
// those of pid_algorithm(), below the controller's location; unsupported for the velocity form.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/code/algorithm.h"
#include "engine/structure/decoupling/decoupler.h"
#include "engine/structure/feedforward.h"

namespace tunewright::structure {

/// u = C2 (r2 - y2), r2 = C1 (r1 - y1). `u`: limits and operating point of the inner controller. `r2`: the range of r2,
/// its value at the operating point (`bias`), which is that of y2 too, and y1 there (`y0`).
///
/// While a limit holds u away from what r2 asks for, the outer integral part follows y2 with the lag Ti (external
/// reset), so that it does not wind up. Without `cascade_on` r2 is the operator's, in manual it is y2; the outer
/// controller follows both. Within the limits the laws are untouched.
Expected<code::Program> cascade_program(const SampledPid& inner, const SampledPid& outer, const code::CodeOptions& u,
                                        const code::CodeOptions& r2);

/// u = C (r - y) - Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s) (d - d0), the lead-lag by backward Euler and the dead time linear
/// between calls. Limits, manual and bias are those of u: the controller has what the feedforward leaves.
Expected<code::Program> feedforward_program(const SampledPid& feedback, const Feedforward& compensator,
                                            const code::CodeOptions& u, double d0 = 0);

/// A controller whose error counts `gap_gain` times within `gap` of the set point, and outside less what that takes
/// away.
Expected<code::Program> level_program(const SampledPid& pid, const code::CodeOptions& u, double gap = 0,
                                      double gap_gain = 0);

/// u_i = C_i (r_i - y_i) + sum_j E_ij (u_j - bias_j), with the u_j that the actuators have had since the last call
/// (decoupling/decoupler.h): so it holds at limits and with loops in manual. That call counts as a part of the dead
/// time. `elements` empty: no decoupling.
Expected<code::Program> interaction_program(const std::vector<SampledPid>& controllers,
                                            const std::vector<code::CodeOptions>& u, const Decoupling& elements = {});

}  // namespace tunewright::structure
