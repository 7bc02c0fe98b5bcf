#include "engine/tuning/method/rule.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

bool given_as_model(const Plant& plant) {
    return std::holds_alternative<Fopdt>(plant) || std::holds_alternative<Sopdt>(plant) ||
           std::holds_alternative<Ipdt>(plant);
}

}  // namespace

Words<ControllerKind> words_of(const std::vector<ControllerKind>& kinds) {
    Words<ControllerKind> words;
    for (const ControllerKind kind : kinds)
        words.emplace_back(kind == ControllerKind::P ? "P" : kind == ControllerKind::PI ? "PI" : "PID", kind);
    return words;
}

OptionSet<ReductionOptions> reduction_options(const std::string& of_auto) {
    using enum ReductionMethod;
    Words<ReductionMethod> words;
    for (const auto method : {automatic, two_point_123c, half_rule, tangent, min_ise, min_iae, min_itae})
        words.emplace_back(to_string(method), method);
    OptionSet<ReductionOptions> set;
    set.choice(&ReductionOptions::method, "method",
               "half_rule: Skogestad's half rule, from poles and zeros; tangent: steepest tangent of the step response "
               "and its 63 % time (asymptote of an integrating plant); 123c: Alfaro's two points, 25 % and 75 % of the "
               "step response; min_ise, min_iae, min_itae: the least integral of the difference of the step responses, "
               "squared, absolute, or absolute times time. auto: " +
                   of_auto,
               words);
    set.field(&ReductionOptions::horizon, "horizon",
              "For min_ise, min_iae and min_itae: the end of the integral; the gain is then fitted too. Default: when "
              "the response has settled, with the plant's static gain.",
              {.unit = "time", .exclusive_minimum = 0});
    return set;
}

OptionSet<FilterOptions> filter_options(const FilterOptions& defaults) {
    OptionSet<FilterOptions> set(defaults);
    set.field(&FilterOptions::Tf_over_Td, "Tf_over_Td", "Filter time over derivative time; 0 for no filter.",
              {.minimum = 0, .maximum = 1});
    set.field(&FilterOptions::Tf, "Tf", "Filter time, fixed.", {.unit = "time", .exclusive_minimum = 0});
    return set;
}

Filter chosen_filter(const FilterOptions& options, FilterType type, double Td) {
    const double Tf = options.Tf.value_or(options.Tf_over_Td * Td);
    return Tf > 0 && Td > 0 ? Filter{type, Tf} : Filter{};
}

Expected<ReducedModel> rule_model(const TuningProblem& problem, const ReductionOptions& options,
                                  ReductionRequest request) {
    request.method = options.method;
    request.horizon = options.horizon;
    return reduce(problem.linear, request);
}

Expected<ReducedModel> half_rule_model(const TuningProblem& problem, const ReductionOptions& options,
                                       ControllerKind controller) {
    const auto order = controller == ControllerKind::PID ? ReducedOrder::second : ReducedOrder::first;
    return rule_model(problem, options, {.order = order, .preferred = ReductionMethod::half_rule});
}

double normalised_dead_time(const ReducedModel& model) {
    return model.integrators > 0 || model.L == 0 ? 0 : model.L / (model.L + model.T1);
}

Error degenerate(const std::string& where, const std::string& sentence, const std::string& cure) {
    return {ErrorKind::unsupported, where, sentence + " " + cure};
}

Warning outside_validity(const std::string& detail) { return {"outside-validity", detail}; }

Warning no_second_lag() {
    return {"no-derivative",
            "The model has no second lag that the rule's derivative action could cancel, so the result is a PI "
            "controller."};
}

Expected<TunedController> rule_answer(const IdealPid& pid, std::vector<Warning> warnings) {
    const bool finite = std::isfinite(pid.Kp) && pid.Kp != 0 && pid.Ti > 0 && std::isfinite(pid.Td) && pid.Td >= 0;
    if (!finite)
        return Error{
            ErrorKind::numerical_failure, "plant",
            "The rule gives Kp = " + text(pid.Kp) + ", Ti = " + text(pid.Ti) + ", Td = " + text(pid.Td) +
                " for this plant, which is not usable. Check the plant's numbers or choose the method robust."};
    TunedController answer;
    answer.controller = pid;
    answer.warnings = std::move(warnings);
    return answer;
}

Expected<TunedController> rule_answer(const TuningProblem& problem, const ReducedModel& model, const IdealPid& pid,
                                      std::vector<Warning> warnings) {
    std::vector<Warning> all = model.warnings;
    all.insert(all.end(), warnings.begin(), warnings.end());
    auto answer = rule_answer(pid, std::move(all));
    if (answer && !(model.exact && given_as_model(problem.plant))) answer->reduced_model = model.plant();
    return answer;
}

}  // namespace tunewright
