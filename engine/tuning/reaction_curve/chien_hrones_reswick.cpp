#include "engine/tuning/reaction_curve/chien_hrones_reswick.h"

namespace tunewright {
namespace {

IdealPid regulation(ControllerKind controller, bool overshoots, double a, double L) {
    if (controller == ControllerKind::P) return {.Kp = (overshoots ? 0.7 : 0.3) / a};
    if (controller == ControllerKind::PI) return {.Kp = (overshoots ? 0.7 : 0.6) / a, .Ti = (overshoots ? 2.3 : 4) * L};
    return {.Kp = (overshoots ? 1.2 : 0.95) / a, .Ti = (overshoots ? 2 : 2.4) * L, .Td = 0.42 * L};
}

IdealPid servo(ControllerKind controller, bool overshoots, double a, double T, double L) {
    if (controller == ControllerKind::P) return {.Kp = (overshoots ? 0.7 : 0.3) / a};
    if (controller == ControllerKind::PI)
        return {.Kp = (overshoots ? 0.6 : 0.35) / a, .Ti = (overshoots ? 1 : 1.2) * T};
    return {.Kp = (overshoots ? 0.95 : 0.6) / a, .Ti = (overshoots ? 1.4 : 1) * T, .Td = (overshoots ? 0.47 : 0.5) * L};
}

Expected<TunedController> tune_chien_hrones_reswick(const TuningProblem& problem,
                                                    const ChienHronesReswickOptions& options) {
    const ControllerKind controller = options.controller;
    const bool for_load = options.mode == Mode::regulation;
    const bool overshoots = options.overshoot == DesignOvershoot::twenty_percent;
    return tune_first_order(problem, options.model,
                            {.name = std::string("Chien-Hrones-Reswick") + (for_load ? "" : " for set points"),
                             .min = 0.1,
                             .max = 1,
                             .has_integrating_form = for_load || controller == ControllerKind::P,
                             .tangent_time = TangentTime::by_slope},
                            [&](const ReducedModel& model) {
                                const double slope = model.integrators == 1 ? model.K : model.K / model.T1;
                                return for_load ? regulation(controller, overshoots, slope * model.L, model.L)
                                                : servo(controller, overshoots, slope * model.L, model.T1, model.L);
                            });
}

}  // namespace

TuningMethod chien_hrones_reswick_method() {
    TuningMethod method;
    method.id = "chien_hrones_reswick";
    method.title = "Chien-Hrones-Reswick";
    method.formula =
        "a = K L/T; integrating: a = K L; regulation, 0 %: P: Kp = 0.3/a; PI: Kp = 0.6/a, Ti = 4 L; PID: Kp = "
        "0.95/a, Ti = 2.4 L, Td = 0.42 L; regulation, 20 %: P: Kp = 0.7/a; PI: Kp = 0.7/a, Ti = 2.3 L; PID: Kp = "
        "1.2/a, Ti = 2 L, Td = 0.42 L; servo, 0 %: P: Kp = 0.3/a; PI: Kp = 0.35/a, Ti = 1.2 T; PID: Kp = 0.6/a, "
        "Ti = T, Td = 0.5 L; servo, 20 %: P: Kp = 0.7/a; PI: Kp = 0.6/a, Ti = T; PID: Kp = 0.95/a, Ti = 1.4 T, Td "
        "= 0.47 L";
    method.source = "Chien, Hrones and Reswick, Trans. ASME 74 (1952) 175-185";
    method.needs =
        "fopdt with T > 0 and L > 0, regulation also ipdt (others are reduced; T is then static gain over steepest "
        "slope)";
    method.validity = "L/T from 0.1 to 1";
    using enum ControllerKind;
    using enum DesignOvershoot;
    OptionSet<ChienHronesReswickOptions> options;
    add_controller(options, {P, PI, PID});
    add_mode(options);
    options.choice(&ChienHronesReswickOptions::overshoot, "overshoot",
                   "Overshoot for which the settings were made, in percent.",
                   Words<DesignOvershoot>{{"0", none}, {"20", twenty_percent}});
    options.embed(&ChienHronesReswickOptions::model, first_order_options());
    method.variants = {
        {"PI, regulation, 0 %", options.given_for({.controller = PI})},
        {"PI, servo, 0 %", options.given_for({.controller = PI, .mode = Mode::servo})},
        {"PID, regulation, 0 %", {}},
        {"PID, regulation, 20 %", options.given_for({.overshoot = twenty_percent})},
        {"PID, servo, 0 %", options.given_for({.mode = Mode::servo})},
        {"PID, servo, 20 %", options.given_for({.mode = Mode::servo, .overshoot = twenty_percent})},
    };
    method.bind(options, tune_chien_hrones_reswick);
    return method;
}

}  // namespace tunewright
