#include "engine/request/rimc_entry.h"

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
    if (!loop.stable()) {
        full.robustness = unstable_robustness({.unstable_poles = 1});
        full.load = no_performance("The closed loop is not stable.").load;
        return full;
    }
    const LoopGrid grid = loop.grid();
    full.robustness = robustness_of(loop.peaks(grid), loop.margins(grid));
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

// Without dead time in the model Eq. 23 is a PI controller, and nothing else need be evaluated.
std::optional<FullController> as_pi(const ImcController& c, const Plant& plant, EvaluateOptions options) {
    options.actuator.reset();
    const auto evaluation = evaluate(plant, maclaurin_pid(rimc_terms(c)), options);
    if (!evaluation) return std::nullopt;
    return FullController{evaluation->robustness, evaluation->performance.load, evaluation->responses};
}

}  // namespace

RimcEntry rimc_entry(const RimcReport& report, const Plant& plant, const LinearPlant& linear,
                     const EvaluateOptions& options) {
    RimcEntry entry;
    entry.lambda = report.full_controller.lambda;
    entry.Ms = report.Ms;
    entry.disturbance_peak = report.disturbance_peak;
    entry.dead_time_error = report.dead_time_error;
    entry.stability_limit = report.stability_limit;
    entry.disturbance_peak_curve = report.curve;
    entry.why_null = report.why_null;
    if (report.full_controller.theta == 0)
        entry.full_controller = as_pi(report.full_controller, plant, options);
    else if (linear.pole_excess() > 0)
        entry.full_controller = evaluated(report.full_controller, linear, options);
    if (!entry.full_controller)
        entry.why_null["full_controller"] =
            "The plant is biproper (as many zeros as poles); the full controller's loop is not computed for such "
            "plants.";
    return entry;
}

}  // namespace tunewright
