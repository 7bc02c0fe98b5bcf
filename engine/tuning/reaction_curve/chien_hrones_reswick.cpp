#include "engine/tuning/reaction_curve/chien_hrones_reswick.h"

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {
namespace {

Pid regulation(const std::string& controller, double overshoot, double a, double L) {
    const bool swings = overshoot == 20;
    if (controller == "P") return {.Kp = (swings ? 0.7 : 0.3) / a};
    if (controller == "PI") return {.Kp = (swings ? 0.7 : 0.6) / a, .Ti = (swings ? 2.3 : 4) * L};
    return {.Kp = (swings ? 1.2 : 0.95) / a, .Ti = (swings ? 2 : 2.4) * L, .Td = 0.42 * L};
}

Pid servo(const std::string& controller, double overshoot, double a, double T, double L) {
    const bool swings = overshoot == 20;
    if (controller == "P") return {.Kp = (swings ? 0.7 : 0.3) / a};
    if (controller == "PI") return {.Kp = (swings ? 0.6 : 0.35) / a, .Ti = (swings ? 1 : 1.2) * T};
    return {.Kp = (swings ? 0.95 : 0.6) / a, .Ti = (swings ? 1.4 : 1) * T, .Td = (swings ? 0.47 : 0.5) * L};
}

Expected<TunedController> tune(const TuningProblem& problem, const MethodOptions& options, const RunControl&) {
    const std::string controller = chosen_controller(options);
    const bool for_load = options.text("mode").value_or("regulation") == "regulation";
    const double overshoot = options.text("overshoot").value_or("0") == "20" ? 20 : 0;
    return tune_first_order(problem, options,
                            {.name = std::string("Chien-Hrones-Reswick") + (for_load ? "" : " for set points"),
                             .least = 0.1,
                             .most = 1,
                             .has_integrating_form = for_load || controller == "P",
                             .tangent_time = TangentTime::by_slope},
                            [&](const ReducedModel& model) {
                                const double slope = model.integrators == 1 ? model.K : model.K / model.T1;
                                return for_load ? regulation(controller, overshoot, slope * model.L, model.L)
                                                : servo(controller, overshoot, slope * model.L, model.T1, model.L);
                            });
}

OptionDescription overshoot_option() {
    OptionDescription option;
    option.name = "overshoot";
    option.type = OptionType::choice;
    option.sentence = "Overshoot that the settings were made for, in percent.";
    option.default_value = std::string("0");
    option.choices = {"0", "20"};
    return option;
}

}  // namespace

TuningMethod chien_hrones_reswick_method() {
    TuningMethod method;
    method.id = "chien_hrones_reswick";
    method.title = "Chien-Hrones-Reswick";
    method.formula =
        "a = K L/T (integrating: K L). Regulation, 0 %: P: Kp = 0.3/a; PI: 0.6/a, Ti = 4 L; PID: 0.95/a, Ti = 2.4 L, "
        "Td = 0.42 L; 20 %: P: 0.7/a; PI: 0.7/a, 2.3 L; PID: 1.2/a, 2 L, 0.42 L. Servo, 0 %: P: 0.3/a; PI: 0.35/a, "
        "1.2 T; PID: 0.6/a, T, 0.5 L; 20 %: P: 0.7/a; PI: 0.6/a, T; PID: 0.95/a, 1.4 T, 0.47 L";
    method.source = "Chien, Hrones and Reswick, Trans. ASME 74 (1952) 175-185";
    method.needs =
        "fopdt with T > 0 and L > 0, regulation also ipdt (others are reduced; T is then static gain over steepest "
        "slope)";
    method.validity = "L/T from 0.1 to 1";
    method.options = with_first_order_options(
        {controller_option({"P", "PI", "PID"}), mode_option("regulation"), overshoot_option()});
    method.variants = {row("PI, regulation, 0 %", {{"controller", "PI"}}),
                       row("PI, servo, 0 %", {{"controller", "PI"}, {"mode", "servo"}}),
                       row("PID, regulation, 0 %", {}),
                       row("PID, regulation, 20 %", {{"overshoot", "20"}}),
                       row("PID, servo, 0 %", {{"mode", "servo"}}),
                       row("PID, servo, 20 %", {{"mode", "servo"}, {"overshoot", "20"}})};
    method.tune = tune;
    return method;
}

}  // namespace tunewright
