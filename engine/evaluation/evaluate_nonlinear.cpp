#include "engine/evaluation/evaluate_nonlinear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/evaluation/evaluate_linear.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/response_pair.h"
#include "engine/loop/loop.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/nonlinear/nonlinear_loop.h"
#include "engine/simulation/nonlinear/nonlinear_response.h"

namespace tunewright {
namespace {

constexpr int kMaxSteps = 20000;
constexpr double kUnstableHorizon = 10;  // multiple of the plant's dead time and lags: the horizon for an unstable loop
constexpr double kMaxIaeDifference = 0.2;              // relative difference of an IAE
constexpr double kMaxOvershootDifferencePercent = 10;  // difference of an overshoot, percent of the step

struct Runs {
    NonlinearResponse setpoint, load;
    bool complete() const { return !incomplete(setpoint) && !incomplete(load); }
    static bool incomplete(const NonlinearResponse& run) { return run.escaped || !run.ended.empty(); }
};

Runs simulate(const NonlinearSystem& system, const Controller& controller, const EvaluateOptions& o,
              std::optional<double> horizon) {
    NonlinearOptions options;
    options.horizon = horizon;
    options.max_steps = kMaxSteps;
    options.actuator = o.actuator;
    options.stop = o.stop;
    if (const auto* npid = std::get_if<Npid>(&controller)) options.delta_r = npid->delta_r;
    const ParallelPid law = gains(controller);
    return {simulate_nonlinear(system, law, {o.setpoint_step, 0}, options),
            simulate_nonlinear(system, law, {0, o.load_step}, options)};
}

void drop_warnings(Evaluation& evaluation, std::initializer_list<const char*> codes) {
    std::erase_if(evaluation.warnings,
                  [&](const Warning& w) { return std::ranges::find(codes, w.code) != codes.end(); });
}

void warn_of_runs(Evaluation& evaluation, const Runs& runs) {
    bool settles = true;
    for (const auto& [run, step] : {std::pair(&runs.setpoint, "set-point"), std::pair(&runs.load, "load")}) {
        if (run->escaped)
            evaluation.warnings.push_back({"left-domain", std::string("After the ") + step + " step: " + run->ended});
        if (run->limited) warn_of_limit(evaluation, step);
        settles = settles && (run->escaped || run->loop.settles);
    }
    if (!settles) warn_of_no_rest(evaluation);
}

/// Warns if the linearisation's figures for these steps differ much from the plant's own.
void warn_of_distance(Evaluation& evaluation) {
    const Performance &own = evaluation.performance, &linear = evaluation.linear->performance;
    std::string differences;
    const auto say = [&](const std::string& what, double a, double b, const char* unit) {
        differences += (differences.empty() ? "" : ", ") + what + " " + text(a) + unit + " against " + text(b) + unit;
    };
    const auto compare = [&](const std::optional<double>& a, const std::optional<double>& b, const char* what) {
        if (a && b && std::abs(*a - *b) > kMaxIaeDifference * std::min(*a, *b)) say(what, *a, *b, "");
    };
    compare(own.setpoint.IAE, linear.setpoint.IAE, "set-point IAE");
    const auto &a = own.setpoint.overshoot_percent, &b = linear.setpoint.overshoot_percent;
    if (a && b && std::abs(*a - *b) > kMaxOvershootDifferencePercent) say("overshoot", *a, *b, " %");
    compare(own.load.IAE, linear.load.IAE, "load IAE");
    if (differences.empty()) return;
    evaluation.warnings.push_back(
        {"far-from-linear",
         "For steps of these sizes the plant differs much from its linearisation, to which Ms and the margins "
         "belong: " +
             differences + "."});
}

/// The linearisation's responses have the same horizon as the plant's own, for comparison.
void add_responses(Evaluation& evaluation, Runs runs, const EvaluateOptions& options) {
    if (runs.setpoint.loop.nodes.empty() || runs.load.loop.nodes.empty()) return;
    const auto run_of = [](NonlinearResponse& run) {
        KnownResponse known = KnownResponse::of(std::move(run.loop));
        if (Runs::incomplete(run)) known.known_to = run.t_end;
        return known;
    };
    const bool complete = runs.complete();
    evaluation.responses = drawn(run_of(runs.setpoint), run_of(runs.load), options);
    if (!complete || !evaluation.responses || !evaluation.responses->course) return;
    if (auto& linear = evaluation.linear->responses; linear && linear->course)
        linear = responses_of(linear->course, evaluation.responses->course->horizon);
}

void add_performance(Evaluation& evaluation, const Runs& runs, const EvaluateOptions& o) {
    const bool to_infinity = !o.horizon.has_value();
    const auto reason = [](const NonlinearResponse& run) { return "The simulation ended early. " + run.ended; };
    const auto cut = [&](const NonlinearResponse& run) {
        return run.escaped || (!to_infinity && Runs::incomplete(run));
    };
    evaluation.performance.setpoint = cut(runs.setpoint)
                                          ? no_performance(reason(runs.setpoint)).setpoint
                                          : setpoint_figures(runs.setpoint.loop, o.setpoint_step, to_infinity);
    evaluation.performance.load =
        cut(runs.load) ? no_performance(reason(runs.load)).load : load_figures(runs.load.loop, to_infinity);
}

}  // namespace

EvaluateOptions limited_as(const NonlinearSystem& plant, EvaluateOptions options) {
    const ActuatorLimits limits = input_limits(plant, options.actuator);
    options.actuator.reset();
    if (std::isfinite(limits.min) || std::isfinite(limits.max)) options.actuator = limits;
    return options;
}

Expected<Evaluation> evaluate_nonlinear(const AnalysedNonlinear& subject, const Controller& controller,
                                        const EvaluateOptions& options) {
    if (auto error = refuse_evaluation(controller, options)) return *error;
    const NonlinearSystem& system = subject.system;
    const auto loop = Loop::make(subject.linear, gains(controller));
    if (!loop) return of_controller(loop.error());
    const bool stable = count_unstable_poles(*loop).stable();
    std::optional<double> horizon = options.horizon;
    if (!horizon && !stable) horizon = kUnstableHorizon * own_time(subject.linear);
    Runs runs = simulate(system, resolved(controller, options), options, horizon);
    if (auto error = stopped(options)) return *error;

    auto evaluation = evaluate_linear({family_of(Plant(system.linearised())), subject.linear}, controller,
                                      limited_as(system, options));
    if (!evaluation) return evaluation;
    evaluation->linear = LinearisedResponse{evaluation->performance, std::move(evaluation->responses)};
    evaluation->responses.reset();
    drop_warnings(*evaluation, {"actuator-limited", "does-not-settle", "limits-not-applied", "linear-part",
                                "depends-on-step-size", "integral-stalls"});
    if (stable) {
        add_performance(*evaluation, runs, options);
        // Limits are not applied to a linear plant with an Npid: their effect would count as the plant's nonlinearity.
        const bool comparable = !evaluation->nonlinear || !(runs.setpoint.limited || runs.load.limited);
        if (comparable) warn_of_distance(*evaluation);
        if (evaluation->nonlinear) {
            EvaluateOptions limits_apply = options;
            limits_apply.actuator.reset();
            warn_of_nonlinearity(*evaluation, runs.setpoint.loop, runs.load.loop, limits_apply);
        }
    }
    warn_of_runs(*evaluation, runs);
    EvaluateOptions as_run = options;
    as_run.horizon = horizon;
    add_responses(*evaluation, std::move(runs), as_run);
    return evaluation;
}

}  // namespace tunewright
