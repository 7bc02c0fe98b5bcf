#include "engine/tuning/rimc/rimc.h"

#include <cmath>

#include "engine/number_text.h"
#include "engine/tuning/rimc/rimc_branch.h"
#include "engine/tuning/rimc/rimc_report.h"

namespace tunewright {
namespace {

constexpr double kPrintRounding = 1e-6;  // relative: rounding of a lambda or an error that was copied from a printed
                                         // figure
constexpr double kMinLambdaOverLimit = 1.25;  // multiple of the stability limit of lambda below which a warning is
                                              // given
constexpr double kMaxDeadTimeOverLag = 2;     // L/T up to which the source has results
constexpr int kCurvePoints = 60;

RimcFilter filter_of(const RimcOptions& options) {
    return {.linear_fraction = options.approximation == RimcApproximation::linear_fractional,
            .Tf_over_Td = options.Tf_over_Td.value_or(RimcFilter{}.Tf_over_Td)};
}

std::optional<Error> contradictory(const RimcOptions& options) {
    const char* first = nullptr;
    for (const auto& [name, given] : {std::pair("lambda", options.lambda.has_value()),
                                      {"Ms", options.Ms.has_value()},
                                      {"disturbance_peak", options.disturbance_peak.has_value()},
                                      {"dead_time_error", options.dead_time_error.has_value()}}) {
        if (!given) continue;
        if (first)
            return Error{ErrorKind::invalid_argument, name,
                         std::string(first) + " and " + name +
                             " are both given, but each of lambda, Ms, disturbance_peak and dead_time_error determines "
                             "lambda. Give only one of them."};
        first = name;
    }
    if (options.Tf_over_Td && filter_of(options).linear_fraction)
        return Error{ErrorKind::invalid_argument, "Tf_over_Td",
                     "The linear fractional approximation has its own filter time. Omit Tf_over_Td, or use the "
                     "approximation maclaurin."};
    return std::nullopt;
}

std::optional<Error> unfit(const ReducedModel& model) {
    if (model.integrators > 0)
        return degenerate("plant",
                          "The revised IMC design cancels a slow, stable pole, but this plant integrates: for infinite "
                          "T its filter zero is not defined.",
                          "Use simc, amigo, lambda or robust.");
    if (model.T1 <= 0)
        return degenerate("plant/T",
                          "The revised IMC design cancels the model's time constant, but the model is a pure dead time "
                          "(T = 0).",
                          "Use imc, amigo or robust.");
    return std::nullopt;
}

Error inadmissible(double lambda, const RimcBranch& branch) {
    const auto [low, high] = branch.admissible();
    return {ErrorKind::no_feasible_controller, "lambda",
            "lambda is " + text(lambda) + "; a PID with K Kp > 0 and Td >= 0" +
                (low > 0 ? " and a filter time > 0" : "") + " exists for lambda " +
                (low > 0 ? "from " + text(low) + " to " : "up to ") + text(high) +
                " on this model. Give a value in that range."};
}

Expected<double> chosen_lambda(const RimcOptions& options, const Fopdt& model, const RimcBranch& branch) {
    if (const auto& Ms = options.Ms) return branch.lambda_for_Ms(*Ms);
    if (const auto& error = options.dead_time_error) return branch.lambda_for_dead_time_error(*error);
    if (const auto& peak = options.disturbance_peak) {
        if (*peak * model.K > 0 || *peak > 0) return branch.lambda_for_disturbance_peak(*peak);
        return Error{
            ErrorKind::invalid_argument, "disturbance_peak",
            "disturbance_peak is " + text(*peak) +
                "; it must not be 0, and must be positive unless the plant's gain is negative. Give the largest "
                "deviation of y per unit of load."};
    }
    const double lambda = options.lambda.value_or(model.T);
    const auto [low, high] = branch.admissible();
    if (lambda > high || lambda <= low) return inadmissible(lambda, branch);
    return lambda;
}

std::shared_ptr<RimcReport> report_on(const Fopdt& model, double lambda, const RimcBranch& branch,
                                      const RimcOptions& options) {
    auto made = std::make_shared<RimcReport>();
    RimcReport& report = *made;
    report.controller = rimc_controller(model, lambda);
    const std::string unstable = "With this lambda the PID does not stabilise the model that it was designed for.";
    report.Ms = Figure(branch.Ms(lambda), unstable);
    report.disturbance_peak = Figure(branch.disturbance_peak(lambda), unstable);
    report.dead_time_error = Figure(branch.dead_time_error(lambda), unstable);
    report.stability_limit = Figure(branch.stability_limit(),
                                    "None of the tried values of lambda is at the limit of stability on the "
                                    "model.");
    if (report.dead_time_error && options.dead_time_error) report.dead_time_error = *options.dead_time_error;
    if (options.curve) report.curve = branch.curve(kCurvePoints);
    return made;
}

void warn_of_stability(std::vector<Warning>& warnings, const Fopdt& model, double lambda, const RimcBranch& branch) {
    const auto limit = branch.stability_limit();
    const std::string figures = limit ? "lambda/T is " + text(lambda / model.T) +
                                            ", but the limit of stability on the model is " + text(*limit / model.T) +
                                            ". "
                                      : "";
    if (!branch.branch())
        warnings.push_back({"unstable-model-loop", "No lambda gives a PID that stabilises the model with L/T = " +
                                                       text(model.L / model.T) + ". Use robust."});
    else if (limit && lambda < *limit)
        warnings.push_back({"unstable-model-loop",
                            figures + "The loop is unstable on the model, and stable on the plant only because of the "
                                      "model's error. Use a larger lambda."});
    else if (limit && lambda < kMinLambdaOverLimit * *limit)
        warnings.push_back({"near-stability-limit", figures + "A small error of the model may make the loop unstable. "
                                                              "Use a larger lambda, or give Ms instead."});
    if (branch.branch() && lambda > branch.branch()->high * (1 + kPrintRounding))
        warnings.push_back(outside_validity("lambda = " + text(lambda) + " is beyond " + text(branch.branch()->high) +
                                            ", where Ms is least (" + text(branch.min_Ms()) +
                                            "), so the response is slower without being more robust."));
}

std::vector<Warning> remarks(const Fopdt& model, double lambda, const RimcBranch& branch, const RimcOptions& options) {
    std::vector<Warning> warnings;
    warn_of_stability(warnings, model, lambda, branch);
    if (model.L > kMaxDeadTimeOverLag * model.T)
        warnings.push_back(outside_validity("L/T is " + text(model.L / model.T) +
                                            ": the design is for plants with a slow time constant; with a dead time "
                                            "above 2 T it gains little, and its PID approximates the design poorly."));
    if (options.dead_time_error) {
        const double asked = *options.dead_time_error, all = branch.dead_time_error(lambda).value_or(0);
        if (all < asked * (1 - kPrintRounding))
            warnings.push_back({"smaller-errors-too",
                                "Eq. 29 holds for the error " + text(asked) +
                                    ", but not for all smaller errors; it holds for every error up to " + text(all) +
                                    ". It is a sufficient condition; delay_margin is exact for later dead times."});
    }
    return warnings;
}

Expected<TunedController> tune(const TuningProblem& problem, const RimcOptions& options) {
    if (const auto error = contradictory(options)) return *error;
    const auto reduced = rule_model(problem, options.reduction, {.preferred = ReductionMethod::half_rule});
    if (!reduced) return reduced.error();
    if (const auto error = unfit(*reduced)) return *error;

    const Fopdt model{reduced->K, reduced->T1, reduced->L};
    const RimcFilter filter = filter_of(options);
    const RimcBranch branch(model, filter);
    const auto lambda = chosen_lambda(options, model, branch);
    if (!lambda) return lambda.error();
    const auto pid = rimc_pid(model, *lambda, filter);
    if (!pid) return inadmissible(*lambda, branch);

    auto answer = rule_answer(problem, *reduced, *pid, remarks(model, *lambda, branch, options));
    if (!answer) return answer;
    answer->report = report_on(model, *lambda, branch, options);
    answer->Ms_limit = options.Ms;
    return answer;
}

OptionSet<RimcOptions> described_options() {
    using O = RimcOptions;
    using enum RimcApproximation;
    OptionSet<O> set;
    set.field(&O::lambda, "lambda",
              "Time constant of the closed loop: larger is slower and more robust. Default, if none of Ms, "
              "disturbance_peak and dead_time_error is given: the model's T.",
              {.unit = "time", .exclusive_minimum = 0});
    set.field(&O::Ms, "Ms", "In place of lambda: the largest |S| of the loop with the model.",
              {.exclusive_minimum = 1, .maximum = 10});
    set.field(&O::disturbance_peak, "disturbance_peak",
              "In place of lambda: the largest deviation of y after a unit load step on the model.", {.unit = "y/u"});
    set.field(&O::dead_time_error, "dead_time_error",
              "In place of lambda: an error of the model's dead time for which the loop stays stable, by the "
              "small-gain condition of Eq. 29 (sufficient only); uses the smallest lambda above which it holds.",
              {.unit = "time", .exclusive_minimum = 0});
    set.field(&O::Tf_over_Td, "Tf_over_Td", "Filter time of the derivative over Td; 0 for none.",
              {.minimum = 0, .maximum = 1, .fallback = RimcFilter{}.Tf_over_Td});
    set.choice(&O::approximation, "approximation",
               "Approximation of the controller of Eq. 23 by a PID: maclaurin: the first three terms of its series; "
               "linear_fractional: (a0 + a1 s + a2 s^2)/(s (1 + b1 s)) with the first four terms, which is the same "
               "PID with the filter time b1.",
               Words<RimcApproximation>{{"maclaurin", maclaurin}, {"linear_fractional", linear_fractional}});
    set.field(&O::curve, "curve",
              "Also return the load response's peak and Ms over lambda/T for this plant (Fig. 2 of the source).");
    set.main({"lambda", "Ms"}).in_place_of("lambda", {"Ms", "disturbance_peak", "dead_time_error"}).draws("curve");
    add_reduction(set, "half_rule; tangent if that does not apply.");
    return set;
}

}  // namespace

TuningMethod rimc_method() {
    TuningMethod method;
    method.id = "rimc";
    method.title = "Revised IMC (Liu and Gao)";
    method.formula =
        "beta = T (1 - (lambda/T - 1)^2 e^(-L/T)), d0 = 2 lambda + L - beta, d1 = lambda^2 + beta L - L^2/2, "
        "d2 = L^3/6 - beta L^2/2; k_c = (beta + T - d1/d0)/(K d0), tau_i = K d0, "
        "tau_d = (beta T - (beta + T) d1/d0 + (d1/d0)^2 - d2/d0)/(K d0); Kp = k_c, Ti = k_c tau_i, Td = tau_d/k_c";
    method.source = "Liu and Gao, IFAC World Congress (2008), Eqs. 16-29";
    method.needs = "fopdt with T > 0 (others are reduced)";
    method.validity =
        "plants with a slow time constant, L up to about 2 T; lambda between the limit of stability and the least Ms";
    method.bind(described_options(), tune);
    return method;
}

}  // namespace tunewright
