// The one statement of what a controller's program computes in a call. Every language is printed from it.
//
// Its law is that of sampled_pid.h: from rest, in automatic and within its limits u is that law's to rounding. Around
// it stand what a controller in a plant needs: limits of u and of its rate, anti-windup, manual and automatic, settings
// that change at run time, and a first call. All times are in seconds.
//
// The integral part is a term in u. Where u has to be a given value (manual, the first call, a change of settings) the
// term is set so that it is, and so nothing jumps. The velocity form has no such term: what it last gave stands for it.
#pragma once

#include <optional>
#include <string>

#include "engine/code/program.h"
#include "engine/controller/sampled/sampled_pid.h"
#include "engine/controller/schedule/schedule.h"
#include "engine/expected.h"

namespace tunewright::code {

enum class AntiWindup {
    back_calculation,  ///< the integral part moves by (Ts/Tt)(u - raw), at most the whole way, raw the law's u
    clamping,          ///< it stands still while the law's u is beyond a limit and it would move further beyond
};

struct CodeOptions {
    AntiWindup anti_windup = AntiWindup::back_calculation;  ///< the velocity form winds nothing up and has none
    std::optional<double> u_min = {}, u_max = {};           ///< as the actuator sees u; u_min < u_max
    double rate_limit = 0;                                  ///< > 0: of u, a second; 0: none
    double bias = 0;                                        ///< u at the operating point
    double y0 = 0;                                          ///< y there
    std::optional<double> delta_r = {};                     ///< of the nonlinear PID: its integral sees phi(e)
    std::optional<double> tracking_time = {};               ///< > 0; without it tracking_time() of settings.h, or Ts
};

constexpr int kMaxSlopeSamples = 1000;
constexpr double kNoLimit = 1e30;  ///< what u_min and u_max are in size where there is none

/// Errors (invalid_argument or unsupported, `where` names the field): Ts, Tf, slope_samples or limits out of range; the
/// forward rule unstable at this Ts; a velocity form without integral action, whose u nothing would bring back.
/// With `follows_schedule` its notes leave the settings to a schedule, which scheduled_algorithm() puts in front.
Expected<Program> pid_algorithm(const SampledPid& pid, const CodeOptions& options, bool follows_schedule = false);

/// What the input of the scheduling variable is called in the programs.
constexpr const char* kSchedulingInput = "scheduling";

/// The row from which what is fixed in the program comes (tracking time, a proposed sample time, whether there is a
/// derivative and a filter): the one with the shortest Ti, of those with a derivative where any has one.
const ScheduleRow& leading_row(const Schedule& schedule);

/// The same program with settings that follow a schedule over one more input: each call computes Kp, Ti, Td, Tf and b
/// before all else. Settings that move between two calls do not move u, so it is bumpless at rows and between.
/// `law`: its rules and sample time; its gains are taken from the leading row. `named`: "level in cm", for the reader.
/// Rows: times in seconds. Errors: those of pid_algorithm; unsupported for a velocity form, for a Kp that changes its
/// sign, and for rows of which some have a filter and others none.
Expected<Program> scheduled_algorithm(const Schedule& schedule, const SampledPid& law, const CodeOptions& options,
                                      const std::string& named);

}  // namespace tunewright::code
