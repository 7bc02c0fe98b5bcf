#include "engine/evaluation/evaluate.h"

#include "engine/evaluation/evaluate_linear.h"
#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/loop/loop.h"

namespace tunewright {

Expected<Evaluation> evaluate(const AnalysedPlant& subject, const Controller& controller,
                              const EvaluateOptions& options) {
    return subject.visit(
        OfKinds{[&](const AnalysedLinear& plant) { return evaluate_linear(plant, controller, options); },
                [&](const MeasuredPlant& plant) { return evaluate_measured(plant, controller, options); },
                [&](const AnalysedNonlinear& plant) { return evaluate_nonlinear(plant, controller, options); }});
}

Expected<Evaluation> evaluate(const PlantModel& plant, const Controller& controller, const EvaluateOptions& options) {
    const auto made = AnalysedPlant::make(plant);
    if (const auto* faults = std::get_if<std::vector<Error>>(&made)) return faults->front();
    return evaluate(std::get<AnalysedPlant>(made), controller, options);
}

std::optional<Error> loop_fault(const AnalysedPlant& subject, const Controller& controller) {
    const auto fault_with = [&](const LinearPlant& plant) -> std::optional<Error> {
        const auto loop = Loop::make(plant, gains(controller));
        return loop ? std::nullopt : std::optional(loop.error());
    };
    if (subject.linear() == nullptr) return std::nullopt;
    if (auto fault = fault_with(*subject.linear())) return fault;
    if (subject.family() == nullptr) return std::nullopt;
    for (const PlantRegion& region : subject.family()->regions)
        if (const auto plant = LinearPlant::make(region.nominal()))
            if (auto fault = fault_with(*plant)) return fault;
    return std::nullopt;
}

EvaluateOptions on_linearisation(const AnalysedPlant& subject, EvaluateOptions options) {
    const NonlinearSystem* system = subject.equations();
    return system ? limited_as(*system, options) : options;
}

}  // namespace tunewright
