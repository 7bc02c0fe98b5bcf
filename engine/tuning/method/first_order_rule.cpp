#include "engine/tuning/method/first_order_rule.h"

#include <optional>

#include "engine/number_text.h"

namespace tunewright {
namespace {

std::vector<Warning> range_warnings(const ReducedModel& model, const FirstOrderRule& rule) {
    if (model.integrators > 0) return {};
    const double ratio = model.L / model.T1;
    if (ratio >= rule.min && ratio <= rule.max) return {};
    std::string range = "outside " + text(rule.min) + " to " + text(rule.max);
    if (rule.min == 0) range = "above " + text(rule.max);
    if (rule.max == std::numeric_limits<double>::infinity()) range = "below " + text(rule.min);
    return {outside_validity("L/T is " + text(ratio) + ", " + range + ", the range of L/T for which " + rule.name +
                             " was made. Check Ms, or use robust.")};
}

}  // namespace

std::optional<Error> unfit(const ReducedModel& model, const FirstOrderRule& rule) {
    if (model.integrators > (rule.has_integrating_form ? 1 : 0))
        return degenerate("plant", rule.name + " has no formulas for integrating plants.",
                          "Use simc, lambda, amigo, ziegler_nichols_ultimate or robust.");
    if (model.L <= 0)
        return degenerate("plant/L", rule.name + " divides by the dead time, but that of the model is 0.",
                          "Give the true dead time of the loop, or use lambda with lambda, simc with tau_c, or robust "
                          "with a fixed filter Tf.");
    if (model.integrators == 0 && model.T1 <= 0)
        return degenerate("plant/T", rule.name + " needs a lag, but the model is a pure dead time (T = 0).",
                          "Use amigo, improved_simc or robust.");
    return std::nullopt;
}

Expected<TunedController> tune_first_order(const TuningProblem& problem, const FirstOrderOptions& options,
                                           const FirstOrderRule& rule,
                                           const std::function<IdealPid(const ReducedModel&)>& settings) {
    const auto model = rule_model(problem, options.reduction,
                                  {.preferred = ReductionMethod::tangent, .tangent_time = rule.tangent_time});
    if (!model) return model.error();
    if (const auto error = unfit(*model, rule)) return *error;
    IdealPid controller = settings(*model);
    if (!(controller.Ti > 0))
        return degenerate("plant",
                          rule.name + " gives a negative integral time for L/T = " + text(model->L / model->T1) +
                              ", far outside its range.",
                          "Use simc, amigo or robust.");
    controller.filter = chosen_filter(options.filter, FilterType::derivative, controller.Td);
    return rule_answer(problem, *model, controller, range_warnings(*model, rule));
}

OptionSet<FirstOrderOptions> first_order_options() {
    OptionSet<FirstOrderOptions> set;
    add_reduction(set, "tangent; half_rule if the step response has no tangent.");
    add_filter(set, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    return set;
}

}  // namespace tunewright
