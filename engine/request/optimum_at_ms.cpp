#include "engine/request/optimum_at_ms.h"

#include <cmath>
#include <string>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluate_linear.h"
#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/rule.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

OptimumAtMs none(const std::string& reason) { return {no_figure(reason), no_figure(reason)}; }

}  // namespace

RobustOptima::RobustOptima(TuningProblem problem, const EvaluateOptions& options)
    : problem_(std::move(problem)), options_(options), front_(problem_) {
    options_.points = 0;
    options_.noise.reset();
}

Expected<double> RobustOptima::load_IAE_at(double Ms, const RunControl& control) {
    const auto design = front_.at(Ms, {control.stop, nullptr, nullptr});
    if (!design) return design.error();
    // With an infinite horizon and without limits the loop is linear, and the search has already simulated it.
    if (!options_.horizon && !options_.actuator) return design->load_IAE * std::abs(options_.load_step);
    const auto evaluation = evaluate(PlantModel(problem_.plant), design->controller, options_);
    if (!evaluation) return evaluation.error();
    const auto& load = evaluation->performance.load;
    if (load.IAE) return *load.IAE;
    return Error{ErrorKind::numerical_failure, "",
                 load.IAE.why.empty() ? "The optimum's load IAE is not finite." : load.IAE.why};
}

OptimumAtMs RobustOptima::compare_at_Ms(const Evaluation& evaluation, const RunControl& control) {
    const auto& Ms = evaluation.robustness.Ms;
    if (!Ms) return none("The loop has no Ms, so there is no optimum to compare it with.");
    if (*Ms <= 1 || *Ms > limits::kMaxMs)
        return none("Ms is " + text(*Ms) + "; optima are computed for Ms above 1 and up to " + text(limits::kMaxMs) +
                    ".");
    const auto optimum = load_IAE_at(*Ms, control);
    if (!optimum) return none(optimum.error().message);
    OptimumAtMs answer{*optimum, {}};
    const Performance& performance = evaluation.linear ? evaluation.linear->performance : evaluation.performance;
    if (const auto& IAE = performance.load.IAE; IAE && *answer.IAE > 0)
        answer.excess_percent = 100 * (*IAE / *answer.IAE - 1);
    else
        answer.excess_percent = no_figure("The controller's load IAE is not finite.");
    return answer;
}

std::optional<double> best_PI_load_IAE(const TuningProblem& problem, const MethodOptions& of_pid,
                                       const EvaluateOptions& options, const RunControl& control) {
    if (problem.family || problem.nonlinear != nullptr || of_pid.text("objective") != "load_iae") return std::nullopt;
    MethodOptions of_PI;
    for (const auto& [path, value] : of_pid.values())
        if (path != "filter/Tf_over_Td" && path != "surface") of_PI.set(path, value);
    of_PI.set(kControllerOption, std::string("PI"));
    const auto tuned = find_method("robust")->tune(problem, of_PI, {control.stop, nullptr, nullptr});
    if (!tuned || tuned->partial) return std::nullopt;
    return load_IAE(problem.linear, controller_of(*tuned), options).value;
}

}  // namespace tunewright
