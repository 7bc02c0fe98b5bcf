// The plan of a controller's program, decided once from the law and the options, and its description for the reader.
#pragma once

#include <string>
#include <vector>

#include "engine/code/algorithm.h"
#include "engine/code/settings.h"

namespace tunewright::code {

/// The rule in use: without a filter of the derivative the filtered rules become the difference.
inline DerivativeRule effective_rule(const SampledPid& pid) {
    const bool filtered = pid.derivative == DerivativeRule::filtered_backward ||
                          pid.derivative == DerivativeRule::filtered_forward ||
                          pid.derivative == DerivativeRule::filtered_trapezoidal;
    return filtered && pid.gains.filter.type != FilterType::derivative ? DerivativeRule::difference : pid.derivative;
}

struct Plan {
    const SampledPid& pid;
    const CodeOptions& options;
    bool follows_schedule = false;  ///< a schedule sets the settings; the user must not change them
    Settings settings = settings_of(pid.gains);
    FilterType filter = pid.gains.filter.type;
    bool integral = pid.gains.Ki != 0;
    bool derivative = pid.gains.Kd != 0;
    bool position = !pid.velocity;
    bool keeps_error = integral && pid.integral != IntegralRule::backward;
    DerivativeRule rule = effective_rule(pid);
    bool tracks = integral && position && options.anti_windup == AntiWindup::back_calculation;

    bool smooths() const { return filter == FilterType::measurement_first_order || smooths_twice(); }
    bool smooths_twice() const { return filter == FilterType::measurement_second_order; }
    bool filters_setpoint() const { return pid.gains.setpoint_lag > 0; }
    bool filters_slope() const {
        return derivative && (rule == DerivativeRule::filtered_backward || rule == DerivativeRule::filtered_forward ||
                              rule == DerivativeRule::filtered_trapezoidal);
    }
};

/// The description above the program, in paragraphs that hold for every language: the law with its rules, limits and
/// anti-windup, manual, changes at run time, the first call. Names are those of the program's variables.
std::vector<std::string> notes(const Plan& plan);

}  // namespace tunewright::code
