#include "engine/tuning/model_based/improved_simc.h"

#include <algorithm>

#include "engine/number_text.h"

namespace tunewright {
namespace {

IdealPid improved_pi(const ReducedModel& model, double tau_c) {
    const double horizon = tau_c + model.L, T = model.T1 + model.L / 3;
    if (model.integrators == 1) return {.Kp = 1 / (model.K * horizon), .Ti = 4 * horizon};
    return {.Kp = T / (model.K * horizon), .Ti = std::min(T, 4 * horizon)};
}

// Series Kp, Ti, Td as Kp (1 + Td/Ti), Ti + Td, Ti Td/(Ti + Td); written without the quotient Kp/Ti, which is 0/0 for a
// pure dead time.
IdealPid improved_pid(const ReducedModel& model, double tau_c) {
    const double horizon = tau_c + model.L, Td = model.L / 3;
    const bool integrates = model.integrators == 1;
    const double Ti = integrates ? 4 * horizon : std::min(model.T1, 4 * horizon);
    const double Kp = (integrates ? 1 : model.T1) / (model.K * horizon);
    const double Ki = !integrates && Ti == model.T1 ? 1 / (model.K * horizon) : Kp / Ti;
    return {.Kp = Kp + Ki * Td, .Ti = Ti + Td, .Td = Ti * Td / (Ti + Td)};
}

Expected<TunedController> tune_improved_simc(const TuningProblem& problem, const ImprovedSimcOptions& options) {
    const auto model = rule_model(problem, options.reduction, {.preferred = ReductionMethod::half_rule});
    if (!model) return model.error();
    if (model->L <= 0)
        return degenerate("plant/L", "The improvement over SIMC depends on the dead time, but that of the model is 0.",
                          "Use simc with tau_c, the closed-loop time constant that you want.");
    const bool wants_PID = options.controller == ControllerKind::PID;
    const double min = wants_PID ? model->L / 2 : model->L;
    const double tau_c = options.tau_c.value_or(min);
    IdealPid answer = wants_PID ? improved_pid(*model, tau_c) : improved_pi(*model, tau_c);
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    std::vector<Warning> warnings;
    if (tau_c < min)
        warnings.push_back(outside_validity("tau_c = " + text(tau_c) + " is below " + text(min) +
                                            ", the smallest that the source recommends for this model."));
    return rule_answer(problem, *model, answer, std::move(warnings));
}

}  // namespace

TuningMethod improved_simc_method() {
    TuningMethod method;
    method.id = "improved_simc";
    method.title = "Improved SIMC (Grimholt, Skogestad)";
    method.formula =
        "PI: Kp = (T + L/3)/(K (tau_c + L)), Ti = min(T + L/3, 4 (tau_c + L)); PID, series form: Kp = T/(K (tau_c + "
        "L)), Ti = min(T, 4 (tau_c + L)), Td = L/3, converted to the ideal form; integrating: Kp = 1/(K (tau_c + L)), "
        "Ti = 4 (tau_c + L)";
    method.source =
        "Grimholt and Skogestad, IFAC Conf. Advances in PID Control (2012); PID: J. Process Control 70 (2018) 36-46";
    method.needs = "fopdt or ipdt with L > 0 (others are reduced)";
    method.validity = "tau_c >= L for PI, >= L/2 for PID";
    OptionSet<ImprovedSimcOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.field(&ImprovedSimcOptions::tau_c, "tau_c",
                  "Desired closed-loop time constant: larger is slower and more robust. Default: the model's dead time "
                  "L for PI, L/2 for PID.",
                  {.unit = "time", .exclusive_minimum = 0});
    options.main({"tau_c"}).slider("tau_c");
    add_reduction(options, "half_rule, as in SIMC; tangent if that does not apply.");
    add_filter(options, "of the derivative part of the ideal form, Td s/(1 + s Tf).");
    method.bind(options, tune_improved_simc);
    return method;
}

}  // namespace tunewright
