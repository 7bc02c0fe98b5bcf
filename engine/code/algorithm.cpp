#include "engine/code/algorithm.h"

#include <cmath>

#include "engine/code/builder.h"
#include "engine/number_text.h"

namespace tunewright::code {

namespace {

Error invalid(const char* where, const std::string& sentence) { return {ErrorKind::invalid_argument, where, sentence}; }

bool above_zero(double x) { return x > 0 && std::isfinite(x); }

std::optional<Error> timing_fault(const Plan& plan) {
    const double Ts = plan.pid.Ts, Tf = plan.pid.gains.filter.Tf;
    if (!above_zero(Ts)) return invalid("sample_time", "sample_time is " + text(Ts) + " s; it must be above 0.");
    if (plan.filter != FilterType::none && !above_zero(Tf))
        return invalid("controller/filter/Tf", "Tf is " + text(Tf) + "; it must be above 0.");
    if (plan.derivative && plan.rule == DerivativeRule::filtered_forward && !(Tf > Ts / 2))
        return invalid("derivative",
                       "derivative is filtered_forward, which is stable only for Tf above half the sample "
                       "time; Tf is " +
                           text(Tf) + " s and the sample time " + text(Ts) +
                           " s. Choose filtered_backward, or sample more often.");
    if (plan.derivative && plan.rule == DerivativeRule::slope &&
        !(plan.pid.slope_samples >= 1 && plan.pid.slope_samples <= kMostSlopeSamples))
        return invalid("slope_samples", "slope_samples is " + std::to_string(plan.pid.slope_samples) +
                                            "; it must be 1 to " + std::to_string(kMostSlopeSamples) + ".");
    return std::nullopt;
}

std::optional<Error> option_fault(const Plan& plan) {
    const CodeOptions& options = plan.options;
    const double u_min = options.u_min.value_or(-kNoLimit), u_max = options.u_max.value_or(kNoLimit);
    if (!(u_min < u_max))
        return invalid("u_max", "u_max is " + text(u_max) + " and u_min " + text(u_min) + "; u_max must be > u_min.");
    if (!(options.rate_limit >= 0) || !std::isfinite(options.rate_limit))
        return invalid("rate_limit", "rate_limit is " + text(options.rate_limit) + "; it must be >= 0.");
    if (options.tracking_time && !above_zero(*options.tracking_time))
        return invalid("tracking_time", "tracking_time is " + text(*options.tracking_time) + "; it must be above 0.");
    if (options.delta_r && !above_zero(*options.delta_r))
        return invalid("controller/delta_r", "delta_r is " + text(*options.delta_r) + "; it must be above 0.");
    if (options.delta_r && plan.smooths())
        return Error{ErrorKind::unsupported, "controller/filter",
                     "The nonlinear form has no filter of the measurement. Choose none or derivative."};
    if (!plan.position && !plan.integral)
        return Error{ErrorKind::unsupported, "form",
                     "form is velocity and the controller has no integral action: after a limit nothing would bring u "
                     "back to its level. Choose position."};
    return std::nullopt;
}

}  // namespace

Expected<Program> pid_algorithm(const SampledPid& pid, const CodeOptions& options, bool follows_schedule) {
    const Plan plan{pid, options, follows_schedule};
    if (const auto fault = timing_fault(plan)) return *fault;
    if (const auto fault = option_fault(plan)) return *fault;
    Program program = Builder(pid, options).build();
    program.notes = notes(plan);
    return program;
}

}  // namespace tunewright::code
