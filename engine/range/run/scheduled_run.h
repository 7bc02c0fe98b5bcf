// Simulates the equations with an active schedule: steps and ramps across the range, with settings that change on the
// way.
//
//   u = I + Kp(s) (r - y_f) - Kd(s) y_f',   I' = Ki(s) (r - y_f) - (1 - b) Kp(s) r' + (u_limited - u)/Tt
//
// s is the scheduling variable: y, the integral part I (along the input), or the parameter. The integral is that of
// Ki(s) e, not Ki(s) times one of e, so it keeps its value when Ki changes; with steps between rows I compensates for
// the change of the other two parts at a switch. A change of settings therefore never makes u jump (bumpless), and in
// steady state, with e = 0, the loop is the one that was designed: no hidden coupling (Rugh and Shamma, Automatica 36
// (2000) 1401-1425, section 4). While e is not 0, a schedule over y adds Kp'(s) e to the gain from y to u.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/warning.h"

namespace tunewright::range {

/// The set point of y, or along a parameter the parameter itself. Linear between points; a jump where two have the same
/// time.
struct ProfilePoint {
    double t = 0, value = 0;  ///< absolute
};
using Profile = std::vector<ProfilePoint>;

struct RunOptions {
    double horizon = 0;       ///< > 0
    int samples = 401;        ///< evenly over the horizon, at least 2
    double tolerance = 1e-7;  ///< error of each step, relative to the range of each state
    int max_steps = 100000;
    std::stop_token stop = {};
};

struct ScheduledRun {
    std::vector<double> t, target, y, u, at, Kp;  ///< samples, absolute; `target`: the set point; u after the limits
    double IAE = 0;                               ///< of the set point minus y, over the run
    double largest_error = 0;                     ///< of abs(set point - y) at the samples
    double largest_bump = 0;                      ///< of u, at a switch of settings (0 except for rounding)
    int switches = 0;                             ///< changes of rows, with `steps`
    bool limited = false;                         ///< u reached a limit
    bool settled = false;                         ///< at the end, y is within 1 % of the profile's size of the set
                                                  ///< point
    std::string ended;                            ///< the reason for an early end; empty: it reached the end
    std::vector<Warning> warnings;  ///< "schedule-coupling": the effect of the moving settings on the gain
};

/// Runs from rest at the profile's first value. Steps end at the profile's points and their echoes after a dead time.
/// Errors: those of SteadyBranch::at; invalid_argument, `where` = "profile": empty, not ascending in t, its first value
/// outside the range.
Expected<ScheduledRun> run_schedule(const SteadyBranch& branch, const Schedule& schedule, const Profile& profile,
                                    const RunOptions& options);

/// A step across the range under the input/output linearising controller that knows the equations and their states
/// (simulation/nonlinear/linearising_response.h): a reference for the best that any controller could do, for comparison
/// with the schedule. With it the loop is 1/(tau s/r + 1)^r, r the relative degree.
struct LinearisingPassage {
    ScheduledRun run;  ///< without Kp; `at` is y
    double tau = 0;
};

/// From rest at the first value of a profile of one step, over y. tau: the largest Ti/(K Kp) of the rows with the gain
/// of the plant there, the time constant of the loop with a well tuned PI: the controller is as fast as the schedule at
/// its slowest point. Errors: unsupported if there is no such controller (a parameter changes, not a single step, no
/// relative degree, unstable zero dynamics; the message says which); those of SteadyBranch::at.
Expected<LinearisingPassage> run_linearising(const SteadyBranch& branch, const Schedule& schedule,
                                             const Profile& profile, const RunOptions& options);

}  // namespace tunewright::range
