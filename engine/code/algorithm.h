// Builds the program that a controller computes in each call, independent of the language. Every language is printed
// from it.
//
// Its law is that of sampled_pid.h: from rest, in automatic and within its limits, u agrees with that law to rounding.
// The program adds the parts that a controller in a plant needs: limits of u and of its rate, anti-windup, manual and
// automatic, settings that change at run time, and a first call. All times are in seconds.
//
// The integral part is a term in u. If u must have a given value (manual, the first call, a change of settings), the
// term is set to give that value, so that u does not jump. The velocity form has no such term: its last output takes
// that place.
#pragma once

#include <optional>
#include <string>

#include "engine/code/program.h"
#include "engine/controller/sampled/sampled_pid.h"
#include "engine/controller/schedule/schedule.h"
#include "engine/expected.h"

namespace tunewright::code {

enum class AntiWindup {
    back_calculation,  ///< the integral part moves by (Ts/Tt)(u - raw), at most by all of it; raw is the law's u
    clamping,          ///< the integral part stops while the law's u is beyond a limit and would move further beyond
};

struct CodeOptions {
    AntiWindup anti_windup = AntiWindup::back_calculation;  ///< the velocity form needs none: nothing winds up
    std::optional<double> u_min = {}, u_max = {};           ///< as the actuator receives u; u_min < u_max
    double rate_limit = 0;                                  ///< > 0: largest change of u per second; 0: no limit
    double bias = 0;                                        ///< u at the operating point
    double y0 = 0;                                          ///< y there
    std::optional<double> delta_r = {};                     ///< for the nonlinear PID: its integral acts on phi(e)
    std::optional<double> tracking_time = {};               ///< > 0; default: tracking_time() of settings.h, or Ts
};

constexpr int kMaxSlopeSamples = 1000;
constexpr double kNoLimit = 1e30;  ///< size of u_min and u_max that stands for no limit

/// The notes of its program, in this order.
enum class PidNote { law, limits, windup, manual, changes, start };

/// Errors (invalid_argument or unsupported, `where` names the field): Ts, Tf, slope_samples or limits out of range; the
/// forward rule unstable at this Ts; a velocity form without integral action, whose u would not return after a limit.
/// With `follows_schedule` its notes say that a schedule sets the settings; scheduled_algorithm() adds that schedule.
Expected<Program> pid_algorithm(const SampledPid& pid, const CodeOptions& options, bool follows_schedule = false);

/// Name of the scheduling variable's input in the programs.
constexpr const char* kSchedulingInput = "scheduling";

/// The row that decides the fixed parts of the program (tracking time, proposed sample time, whether there is a
/// derivative and a filter): the one with the shortest Ti among those with a derivative, or among all if none has one.
const ScheduleRow& leading_row(const Schedule& schedule);

/// The same program with settings that follow a schedule over one more input: each call first computes Kp, Ti, Td, Tf
/// and b. A change of settings between two calls does not change u, so the program is bumpless at rows and between
/// them. `law`: gives the rules and the sample time; the gains are those of the leading row. `named`: description of
/// the input, such as "level in cm". Rows: times in seconds. Errors: those of pid_algorithm; unsupported for a velocity
/// form, for a Kp that changes its sign, and if some rows have a filter and others have none.
Expected<Program> scheduled_algorithm(const Schedule& schedule, const SampledPid& law, const CodeOptions& options,
                                      const std::string& named);

}  // namespace tunewright::code
