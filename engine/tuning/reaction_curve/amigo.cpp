#include "engine/tuning/reaction_curve/amigo.h"

#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

IdealPid amigo_pi(const ReducedModel& model) {
    const double K = model.K, T = model.T1, L = model.L;
    if (model.integrators == 1) return {.Kp = 0.35 / (K * L), .Ti = 13.4 * L};
    return {.Kp = (0.15 + (0.35 - L * T / std::pow(L + T, 2)) * T / L) / K,
            .Ti = 0.35 * L + 13 * L * T * T / (T * T + 12 * L * T + 7 * L * L)};
}

IdealPid amigo_pid(const ReducedModel& model) {
    const double K = model.K, T = model.T1, L = model.L;
    if (model.integrators == 1) return {.Kp = 0.45 / (K * L), .Ti = 8 * L, .Td = 0.5 * L, .b = 0};
    return {.Kp = (0.2 + 0.45 * T / L) / K,
            .Ti = L * (0.4 * L + 0.8 * T) / (L + 0.1 * T),
            .Td = 0.5 * L * T / (0.3 * L + T),
            .b = normalised_dead_time(model) <= 0.5 ? 0.0 : 1.0};
}

}  // namespace

Expected<TunedController> tune_amigo(const TuningProblem& problem, const AmigoOptions& options) {
    const auto model = rule_model(problem, options.reduction, {.preferred = ReductionMethod::tangent});
    if (!model) return model.error();
    if (model->L <= 0)
        return degenerate("plant/L", "AMIGO divides by the dead time, but that of the model is 0.",
                          "Give the true dead time of the loop, or use lambda with lambda, simc with tau_c, or robust "
                          "with a fixed filter Tf.");

    const bool wants_PID = options.controller == ControllerKind::PID;
    IdealPid controller = wants_PID ? amigo_pid(*model) : amigo_pi(*model);
    controller.filter = chosen_filter(options.filter, FilterType::measurement_second_order, controller.Td);

    std::vector<Warning> warnings;
    const double tau = normalised_dead_time(*model);
    if (wants_PID && tau < 0.3)
        warnings.push_back(
            outside_validity("L/(L + T) is " + text(tau) +
                             ", below 0.3: with so little dead time a first-order model describes the plant poorly, "
                             "and AMIGO's PID is conservative. The method robust can give a better one."));
    return rule_answer(problem, *model, controller, std::move(warnings));
}

TuningMethod amigo_method() {
    TuningMethod method;
    method.id = "amigo";
    method.title = "AMIGO";
    method.formula =
        "PI: Kp = 0.15/K + (0.35 - L T/(L + T)^2) T/(K L), Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2); "
        "PID: Kp = (0.2 + 0.45 T/L)/K, Ti = L (0.4 L + 0.8 T)/(L + 0.1 T), Td = 0.5 L T/(0.3 L + T); "
        "integrating PI: Kp = 0.35/(K L), Ti = 13.4 L; integrating PID: Kp = 0.45/(K L), Ti = 8 L, Td = 0.5 L. "
        "PID: b = 0 for L/(L + T) <= 0.5, else 1";
    method.source =
        "Hägglund and Åström, J. Process Control 14 (2004) 635-650; PI: Asian J. Control 4 (2002) 364-380; Advanced "
        "PID Control (2006), chapter 7";
    method.needs = "fopdt or ipdt with L > 0 (others are reduced)";
    method.validity =
        "plants with an essentially monotone step response; the PID rule is conservative for L/(L + T) below 0.3";
    OptionSet<AmigoOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    add_reduction(options, "tangent, as in the source; half_rule if the step response has no tangent.");
    add_filter(options, "second order on the measurement, as in the source.");
    method.bind(options, tune_amigo);
    return method;
}

}  // namespace tunewright
