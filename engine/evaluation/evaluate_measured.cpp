#include "engine/evaluation/evaluate_measured.h"

#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/frequency_traces.h"
#include "engine/evaluation/nonlinear_figures.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/measured_loop.h"

namespace tunewright {
namespace {

constexpr const char* kNoTime =
    "The plant is known by points of its frequency response alone, which have no response over time.";

}  // namespace

Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options) {
    if (auto error = refuse_evaluation(controller, options)) return *error;
    const auto loop = MeasuredLoop::make(plant, gains(controller));
    if (!loop) return of_controller(loop.error());
    if (const auto reason = loop->band_too_short()) return Error{ErrorKind::unsupported, "controller", *reason};

    Evaluation evaluation = begun(controller, options);
    evaluation.performance = no_performance(kNoTime);
    if (options.noise) evaluation.performance.noise = NoisePerformance{no_figure(kNoTime), no_figure(kNoTime)};
    const StabilityCount count = loop->count_unstable_poles();
    if (count.stable())
        evaluation.robustness = robustness_of(loop->peaks(), loop->margins());
    else
        mark_unstable(evaluation, count);
    if (std::holds_alternative<Npid>(controller)) warn_of_linear_part(evaluation);
    if (options.points >= 2) evaluation.frequency = frequency_traces(*loop, options.points);
    return evaluation;
}

}  // namespace tunewright
