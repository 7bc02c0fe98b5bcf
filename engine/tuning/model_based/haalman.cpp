#include "engine/tuning/model_based/haalman.h"

#include <optional>

#include "engine/number_text.h"
#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {
namespace {

Expected<TunedController> tune_haalman(const TuningProblem& problem, const HaalmanOptions& options) {
    const bool wants_PID = options.controller == ControllerKind::PID;
    const auto model = half_rule_model(problem, options.reduction, options.controller);
    if (!model) return model.error();
    if (const auto error = unfit(*model, {.name = "Haalman's rule"})) return *error;
    const double Ti = model->T1 + model->T2;
    IdealPid answer{.Kp = 2 * Ti / (3 * model->K * model->L), .Ti = Ti, .Td = model->T1 * model->T2 / Ti};
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    std::vector<Warning> warnings;
    if (wants_PID && answer.Td == 0) warnings.push_back(no_second_lag());
    if (model->L < 0.1 * model->T1)
        warnings.push_back(outside_validity("L/T is " + text(model->L / model->T1) +
                                            ", below 0.1: the cancelled lag makes the response to loads slow. Use "
                                            "simc, amigo or robust."));
    return rule_answer(problem, *model, answer, std::move(warnings));
}

}  // namespace

TuningMethod haalman_method() {
    TuningMethod method;
    method.id = "haalman";
    method.title = "Haalman";
    method.formula = "PI: Kp = 2 T/(3 K L), Ti = T; PID: Kp = 2 (T1 + T2)/(3 K L), Ti = T1 + T2, Td = T1 T2/(T1 + T2)";
    method.source = "Haalman, Control Engineering 12 (1965) 71-73; Åström and Hägglund, Advanced PID Control (2006)";
    method.needs = "fopdt for PI, sopdt for PID, T > 0, L > 0 (others are reduced)";
    method.validity = "L/T above 0.1: the rule cancels lags, which makes the response to loads slow below that";
    OptionSet<HaalmanOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    add_reduction(options, "half_rule; tangent (first order: PI) if that does not apply.");
    add_filter(options, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    method.bind(options, tune_haalman);
    return method;
}

}  // namespace tunewright
