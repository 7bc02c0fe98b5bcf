#include "engine/optimum_at_ms.h"

#include <string>
#include <utility>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr double kGreatestMs = 4;  // of the method robust

OptimumAtMs none(const std::string& reason) { return {{}, {}, {{"IAE", reason}, {"excess_percent", reason}}}; }

}  // namespace

RobustOptima::RobustOptima(TuningProblem problem, const EvaluateOptions& options)
    : problem_(std::move(problem)), options_(options) {
    problem_.family.reset();
    options_.points = 0;
    options_.noise.reset();
}

Expected<double> RobustOptima::load_IAE_at(double Ms, const RunControl& control) const {
    MethodOptions limits;
    limits.set("Ms", Ms);
    limits.set("Mt", Ms);
    const auto tuned = find_method("robust")->tune(problem_, limits, {control.stop, nullptr, nullptr});
    if (!tuned) return tuned.error();
    if (tuned->partial) return Error{ErrorKind::cancelled, "", "The job was stopped before this optimum was found."};
    const auto evaluation = evaluate(problem_.plant, tuned->controller, options_);
    if (!evaluation) return evaluation.error();
    const auto& load = evaluation->performance.load;
    if (load.IAE) return *load.IAE;
    const auto why = load.why_null.find("IAE");
    return Error{ErrorKind::numerical_failure, "",
                 why == load.why_null.end() ? "The optimum's load IAE is not finite." : why->second};
}

OptimumAtMs RobustOptima::beside(const Evaluation& evaluation, const RunControl& control) {
    const auto& Ms = evaluation.robustness.Ms;
    if (!Ms) return none("The loop has no Ms, so there is nothing to compare at.");
    if (*Ms <= 1 || *Ms > kGreatestMs)
        return none("Ms is " + text(*Ms) + "; optima are computed for Ms above 1 and up to " + text(kGreatestMs) + ".");
    auto at = known_.find(*Ms);
    if (at == known_.end()) at = known_.emplace(*Ms, load_IAE_at(*Ms, control)).first;
    if (!at->second) return none(at->second.error().message);
    OptimumAtMs answer{*at->second, {}, {}};
    if (const auto& IAE = evaluation.performance.load.IAE; IAE && *answer.IAE > 0)
        answer.excess_percent = 100 * (*IAE / *answer.IAE - 1);
    else
        answer.why_null["excess_percent"] = "The controller's load IAE is not finite.";
    return answer;
}

}  // namespace tunewright
