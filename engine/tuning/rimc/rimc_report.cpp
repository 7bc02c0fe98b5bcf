#include "engine/tuning/rimc/rimc_report.h"

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/measured_response.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/imc_loop.h"
#include "engine/simulation/imc/imc_response.h"
#include "engine/tuning/rimc/rimc_design.h"

namespace tunewright {
namespace {

constexpr double kSettledForFigures = 1e-6;

Responses traces_of(const StepResponse& setpoint, const StepResponse& load, const EvaluateOptions& options) {
    const double horizon = options.horizon.value_or(covering_horizon(setpoint, load));
    return {trace_of(setpoint, horizon, options.points), trace_of(load, horizon, options.points),
            setpoint.settles && load.settles};
}

FullController evaluated(const ImcController& controller, const LinearPlant& plant, const EvaluateOptions& options) {
    FullController full;
    const ImcLoop loop(plant, controller);
    if (const StabilityCount count = count_unstable_poles(loop); !count.stable()) {
        full.robustness = unstable_robustness(count);
        full.load = no_performance("The closed loop is not stable.").load;
        return full;
    }
    const LoopGrid grid = make_loop_grid(loop);
    full.robustness = robustness_of(loop, grid);
    ResponseOptions how;
    how.settled = kSettledForFigures;
    how.horizon = options.horizon;
    const auto simulate = [&](const StepInputs& in) {
        const auto run = [&](const ResponseOptions& finer) { return simulate_imc(plant, controller, in, finer); };
        return measure(run, how, in.r).response;
    };
    const StepResponse load = simulate({0, options.load_step});
    full.load = load_figures(load, !options.horizon);
    if (options.points < 2) return full;
    full.responses = traces_of(simulate({options.setpoint_step, 0}), load, options);
    return full;
}

// Without dead time in the model Eq. 23 is a PI controller, and no other evaluation is needed.
std::optional<FullController> as_pi(const ImcController& c, const Plant& plant, EvaluateOptions options) {
    options.actuator.reset();
    const auto evaluation = evaluate(PlantModel(plant), maclaurin_pid(rimc_terms(c)), options);
    if (!evaluation) return std::nullopt;
    return FullController{evaluation->robustness, evaluation->performance.load, evaluation->responses};
}

}  // namespace

void RimcReport::complete(const ReportContext& context, Evaluation&) {
    const LinearPlant* plant = context.subject.linear();
    if (plant == nullptr) return;
    if (controller.theta == 0)
        full_controller = as_pi(controller, *context.subject.nominal(), context.options);
    else if (plant->pole_excess() > 0)
        full_controller = evaluated(controller, *plant, context.options);
    if (!full_controller)
        full_controller.why =
            "The plant is biproper (as many zeros as poles); the full controller's loop is not computed for such "
            "plants.";
}

}  // namespace tunewright
