#include "engine/tuning/reaction_curve/ziegler_nichols_step.h"

#include "engine/number_text.h"

namespace tunewright {
namespace {

IdealPid settings(ControllerKind controller, double a, double L) {
    if (controller == ControllerKind::P) return {.Kp = 1 / a};
    if (controller == ControllerKind::PI) return {.Kp = 0.9 / a, .Ti = L / 0.3};
    return {.Kp = 1.2 / a, .Ti = 2 * L, .Td = 0.5 * L};
}

Expected<TunedController> tune_ziegler_nichols_step(const TuningProblem& problem,
                                                    const ZieglerNicholsStepOptions& options) {
    const auto model = rule_model(problem, options.reduction,
                                  {.preferred = ReductionMethod::tangent, .tangent_time = TangentTime::by_slope});
    if (!model) return model.error();
    if (model->L <= 0)
        return degenerate("plant/L", "Ziegler-Nichols divides by the dead time, but that of the model is 0.",
                          "Give the true dead time of the loop, or use lambda with lambda, simc with tau_c, or robust "
                          "with a fixed filter Tf.");
    if (model->integrators == 0 && model->T1 <= 0)
        return degenerate(
            "plant/T",
            "Ziegler-Nichols needs a reaction curve with a slope, but the model is a pure dead time (T = 0).",
            "Use amigo or robust.");

    const double slope = model->integrators == 1 ? model->K : model->K / model->T1;
    IdealPid controller = settings(options.controller, slope * model->L, model->L);
    controller.filter = chosen_filter(options.filter, FilterType::derivative, controller.Td);

    std::vector<Warning> warnings;
    const double ratio = model->L / model->T1;
    if (model->integrators == 0 && (ratio < 0.1 || ratio > 1))
        warnings.push_back(outside_validity(
            "L/T is " + text(ratio) + ", outside the usual range 0.1 to 1 of this rule: " +
            (ratio > 1 ? "it is sluggish there." : "it is oscillatory and needs very high gains there.")));
    return rule_answer(problem, *model, controller, std::move(warnings));
}

}  // namespace

TuningMethod ziegler_nichols_step_method() {
    TuningMethod method;
    method.id = "ziegler_nichols_step";
    method.title = "Ziegler-Nichols, step response";
    method.formula =
        "a = K L/T; integrating: a = K L; P: Kp = 1/a; PI: Kp = 0.9/a, Ti = L/0.3; PID: Kp = 1.2/a, Ti = 2 L, Td "
        "= 0.5 L";
    method.source = "Ziegler and Nichols, Trans. ASME 64 (1942) 759-768";
    method.needs = "fopdt or ipdt with L > 0 (others are reduced; T is then static gain over steepest slope)";
    method.validity =
        "L/T from 0.1 to 1 as usually cited (the source gives none); aims at quarter-amplitude damping, Ms is often "
        "above 2";
    OptionSet<ZieglerNicholsStepOptions> options;
    add_controller(options, {ControllerKind::P, ControllerKind::PI, ControllerKind::PID});
    add_reduction(
        options,
        "tangent, as in the source, here with T = static gain over steepest slope; half_rule if there is no tangent.");
    add_filter(options, "of the derivative part, Td s/(1 + s Tf).");
    method.bind(options, tune_ziegler_nichols_step);
    return method;
}

}  // namespace tunewright
