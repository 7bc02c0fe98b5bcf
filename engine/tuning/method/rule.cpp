#include "engine/tuning/method/rule.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr double kTfOverTd = 0.1;  // N = 10

bool given_as_model(const Plant& plant) {
    return std::holds_alternative<Fopdt>(plant) || std::holds_alternative<Sopdt>(plant) ||
           std::holds_alternative<Ipdt>(plant);
}

}  // namespace

OptionDescription controller_option(std::vector<std::string> choices) {
    const bool has_PID = std::ranges::find(choices, "PID") != choices.end();
    OptionDescription option;
    option.name = "controller";
    option.type = OptionType::choice;
    option.sentence = "The controller that is tuned.";
    option.default_value = has_PID ? std::string("PID") : choices.front();
    option.choices = std::move(choices);
    return option;
}

OptionDescription reduction_option(const std::string& automatic) {
    OptionDescription method;
    method.name = "method";
    method.type = OptionType::choice;
    method.sentence =
        "half_rule: Skogestad's half rule, from poles and zeros; tangent: steepest tangent of the step response and "
        "its 63 % time "
        "(asymptote of an integrating plant); 123c: Alfaro's two points, 25 % and 75 % of the step response; min_ise, "
        "min_iae, min_itae: the least integral of the difference of the step responses, "
        "squared, absolute, or absolute times time. auto: " +
        automatic;
    method.default_value = std::string("auto");
    method.choices = {"auto", "123c", "half_rule", "tangent", "min_ise", "min_iae", "min_itae"};
    OptionDescription horizon;
    horizon.name = "horizon";
    horizon.sentence =
        "Of min_ise, min_iae and min_itae: where the integral ends, with the gain fitted too. Default: settled, with "
        "the plant's static gain.";
    horizon.unit = "time";
    horizon.exclusive_minimum = 0;
    OptionDescription option;
    option.name = "reduction";
    option.type = OptionType::object;
    option.sentence = "How a plant that is not of the rule's form is reduced to it.";
    option.fields = {method, horizon};
    return option;
}

OptionDescription filter_option(const std::string& law) {
    OptionDescription ratio;
    ratio.name = "Tf_over_Td";
    ratio.sentence = "Filter time over derivative time; 0 for no filter.";
    ratio.default_value = kTfOverTd;
    ratio.minimum = 0;
    ratio.maximum = 1;
    OptionDescription Tf;
    Tf.name = "Tf";
    Tf.sentence = "Filter time, fixed.";
    Tf.unit = "time";
    Tf.exclusive_minimum = 0;
    OptionDescription option;
    option.name = "filter";
    option.type = OptionType::object;
    option.sentence = "Filter of a PID controller: " + law;
    option.fields = {ratio, Tf};
    option.at_most_fields = 1;
    return option;
}

OptionDescription mode_option(const std::string& by_default) {
    OptionDescription option;
    option.name = "mode";
    option.type = OptionType::choice;
    option.sentence = "What the settings were made for: servo (set-point steps) or regulation (load steps).";
    option.default_value = by_default;
    option.choices = {"servo", "regulation"};
    return option;
}

MethodVariant row(const std::string& name, const std::vector<std::pair<std::string, std::string>>& words) {
    MethodVariant variant{name, {}};
    for (const auto& [path, word] : words) variant.options.set(path, word);
    return variant;
}

std::string chosen_controller(const MethodOptions& options) { return options.text("controller").value_or("PID"); }

Filter chosen_filter(const MethodOptions& options, FilterType type, double Td) {
    const double Tf =
        options.number("filter/Tf").value_or(options.number("filter/Tf_over_Td").value_or(kTfOverTd) * Td);
    return Tf > 0 && Td > 0 ? Filter{type, Tf} : Filter{};
}

Expected<ReducedModel> rule_model(const TuningProblem& problem, const MethodOptions& options,
                                  ReductionRequest request) {
    request.method = reduction_method(options.text("reduction/method").value_or("auto"));
    request.horizon = options.number("reduction/horizon");
    return reduce(problem.linear, request);
}

Expected<ReducedModel> half_rule_model(const TuningProblem& problem, const MethodOptions& options) {
    const auto order = chosen_controller(options) == "PID" ? ReducedOrder::second : ReducedOrder::first;
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
    return {
        "no-derivative",
        "The model has no second lag, which the rule's derivative action would cancel: the answer is a PI controller."};
}

Expected<TunedController> rule_answer(const Pid& pid, std::vector<Warning> warnings) {
    const bool finite = std::isfinite(pid.Kp) && pid.Kp != 0 && pid.Ti > 0 && std::isfinite(pid.Td) && pid.Td >= 0;
    if (!finite)
        return Error{
            ErrorKind::numerical_failure, "plant",
            "The rule gives Kp = " + text(pid.Kp) + ", Ti = " + text(pid.Ti) + ", Td = " + text(pid.Td) +
                " for this plant, beyond what can be used. Check the plant's numbers or choose the method robust."};
    TunedController answer;
    answer.controller = pid;
    answer.warnings = std::move(warnings);
    return answer;
}

Expected<TunedController> rule_answer(const TuningProblem& problem, const ReducedModel& model, const Pid& pid,
                                      std::vector<Warning> warnings) {
    std::vector<Warning> all = model.warnings;
    all.insert(all.end(), warnings.begin(), warnings.end());
    auto answer = rule_answer(pid, std::move(all));
    if (answer && !(model.exact && given_as_model(problem.plant))) answer->reduced_model = model.plant();
    return answer;
}

}  // namespace tunewright
