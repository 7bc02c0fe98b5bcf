#include "engine/tuning/reaction_curve/cohen_coon.h"

namespace tunewright {
namespace {

IdealPid settings(ControllerKind controller, const ReducedModel& model) {
    const double L = model.L, q = L / model.T1, unit = 1 / (model.K * q);
    if (controller == ControllerKind::P) return {.Kp = unit * (1 + q / 3)};
    if (controller == ControllerKind::PI) return {.Kp = unit * (0.9 + q / 12), .Ti = L * (30 + 3 * q) / (9 + 20 * q)};
    return {.Kp = unit * (4.0 / 3 + q / 4), .Ti = L * (32 + 6 * q) / (13 + 8 * q), .Td = 4 * L / (11 + 2 * q)};
}

Expected<TunedController> tune_cohen_coon(const TuningProblem& problem, const CohenCoonOptions& options) {
    return tune_first_order(problem, options.model,
                            {.name = "Cohen-Coon", .min = 0.1, .max = 1, .tangent_time = TangentTime::by_slope},
                            [&](const ReducedModel& model) { return settings(options.controller, model); });
}

}  // namespace

TuningMethod cohen_coon_method() {
    TuningMethod method;
    method.id = "cohen_coon";
    method.title = "Cohen-Coon";
    method.formula =
        "q = L/T; P: Kp = (1 + q/3)/(K q); PI: Kp = (0.9 + q/12)/(K q), Ti = L (30 + 3 q)/(9 + 20 q); PID: Kp = (4/3 + "
        "q/4)/(K q), Ti = L (32 + 6 q)/(13 + 8 q), Td = 4 L/(11 + 2 q)";
    method.source = "Cohen and Coon, Trans. ASME 75 (1953) 827-834";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced; T is then static gain over steepest slope)";
    method.validity = "L/T from 0.1 to 1; aims at quarter-amplitude damping, so expect Ms above 2";
    OptionSet<CohenCoonOptions> options;
    add_controller(options, {ControllerKind::P, ControllerKind::PI, ControllerKind::PID});
    options.embed(&CohenCoonOptions::model, first_order_options());
    method.bind(options, tune_cohen_coon);
    return method;
}

}  // namespace tunewright
