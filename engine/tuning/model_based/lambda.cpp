#include "engine/tuning/model_based/lambda.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

double default_lambda(const ReducedModel& model) {
    return model.integrators == 1 ? std::sqrt(10.0) * model.L : std::max(model.T1, model.L);
}

IdealPid lambda_pi(const ReducedModel& model, double lambda) {
    const double K = model.K, T = model.T1, L = model.L;
    if (model.integrators == 1) return {.Kp = (2 * lambda + L) / (K * std::pow(lambda + L, 2)), .Ti = 2 * lambda + L};
    return {.Kp = T / (K * (lambda + L)), .Ti = T};
}

IdealPid lambda_pid(const ReducedModel& model, double lambda) {
    const double K = model.K, T = model.T1, L = model.L;
    if (model.integrators == 1)
        return {.Kp = (2 * lambda + L) / (K * std::pow(lambda + L / 2, 2)),
                .Ti = 2 * lambda + L,
                .Td = (lambda * L + L * L / 4) / (2 * lambda + L)};
    return {.Kp = (2 * T + L) / (K * (2 * lambda + L)), .Ti = T + L / 2, .Td = T * L / (2 * T + L)};
}

// Rivera et al.'s limits on lambda. For the form used here, those of their PI hold for lambda + L.
std::vector<Warning> remarks(const ReducedModel& model, double lambda, bool wants_PID) {
    if (model.integrators == 1) {
        if (lambda >= model.L) return {};
        return {outside_validity("lambda = " + text(lambda) + " is below the dead time L = " + text(model.L) +
                                 ", so the loop will be oscillatory. Use a larger lambda.")};
    }
    const double min =
        wants_PID ? std::max(0.8 * model.L, 0.1 * model.T1) : std::max(0.7 * model.L, 0.2 * model.T1 - model.L);
    if (lambda >= min) return {};
    return {outside_validity("lambda = " + text(lambda) + " is below " + text(min) +
                             ", the smallest that the source recommends for this model. Use a larger lambda.")};
}

Expected<TunedController> tune_lambda(const TuningProblem& problem, const LambdaOptions& options) {
    const auto model = rule_model(problem, options.reduction, {.preferred = ReductionMethod::tangent});
    if (!model) return model.error();
    if (model->integrators == 0 && model->T1 <= 0)
        return degenerate("plant/T", "Lambda tuning sets Ti = T, but the model is a pure dead time (T = 0).",
                          "Use amigo or robust.");
    const double lambda = options.lambda.value_or(default_lambda(*model));
    if (lambda <= 0)
        return degenerate("plant/L",
                          "The default lambda of an integrating plant is a multiple of its dead time, which is 0.",
                          "Give lambda, the closed-loop time constant that you want.");

    const bool wants_PID = options.controller == ControllerKind::PID;
    IdealPid controller = wants_PID ? lambda_pid(*model, lambda) : lambda_pi(*model, lambda);
    controller.filter = chosen_filter(options.filter, FilterType::derivative, controller.Td);
    return rule_answer(problem, *model, controller, remarks(*model, lambda, wants_PID));
}

}  // namespace

TuningMethod lambda_method() {
    TuningMethod method;
    method.id = "lambda";
    method.title = "Lambda tuning";
    method.formula =
        "PI: Kp = T/(K (lambda + L)), Ti = T; PID: Kp = (2 T + L)/(K (2 lambda + L)), Ti = T + L/2, Td = T L/(2 T + "
        "L); "
        "integrating PI: Kp = (2 lambda + L)/(K (lambda + L)^2), Ti = 2 lambda + L; "
        "integrating PID: Kp = (2 lambda + L)/(K (lambda + L/2)^2), Ti = 2 lambda + L, Td = (lambda L + L^2/4)/(2 "
        "lambda + L)";
    method.source =
        "Rivera, Morari and Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265; Åström and Hägglund, "
        "Advanced PID Control (2006), section 6.5; "
        "integrating: Chien and Fruehauf, Chem. Eng. Prog. 86 (1990) 33-41";
    method.needs = "fopdt with T > 0 or ipdt (others are reduced)";
    method.validity =
        "PID: lambda above 0.8 L and 0.1 T; PI: lambda above 0.7 L and lambda + L above 0.2 T; integrating: lambda "
        "above L";
    OptionSet<LambdaOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.field(
        &LambdaOptions::lambda, "lambda",
        "Desired closed-loop time constant. Default: the larger of T and L; sqrt(10) L for an integrating plant.",
        {.unit = "time", .exclusive_minimum = 0});
    options.main({"lambda"}).slider("lambda");
    add_reduction(options, "tangent; half_rule if the step response has no tangent.");
    add_filter(options, "of the derivative part, Td s/(1 + s Tf).");
    method.bind(options, tune_lambda);
    return method;
}

}  // namespace tunewright
