#include "engine/evaluation/evaluate_linear.h"

#include <algorithm>
#include <cmath>

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/measured_response.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/response_pair.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/integral_sector.h"
#include "engine/loop/measured_loop.h"
#include "engine/number_text.h"
#include "engine/numerics/fast_complex.h"
#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

namespace {

constexpr double kCountRounding = 1e-9;  // relative rounding of the ratio of samples

constexpr double kMinEncirclingModulus = 0.5;  // of |L|, with a margin for values between two frequencies
constexpr int kMinNodes = 8;
constexpr double kMaxFurtherNodes = 12;

constexpr double kFinalTolerance = 1e-4;      // interpolation within a step, relative to the local deviation
constexpr double kNonlinearTolerance = 1e-5;  // for the integral's nonlinear input as well
constexpr double kSettledForFigures = 3e-7;
constexpr int kMaxNonlinearSteps = 20000;  // the integral may stall for any number of steps

/// Nodes of the discretised dead time. A pole leaves the left half-plane where |L| is 1, so the discretisation must be
/// accurate there.
int nodes_for(const Loop& loop, const LoopGrid& grid) {
    double highest = 0;
    for (std::size_t i = 0; i < grid.omega.size(); ++i)
        if (magnitude(grid.point[i].L) > kMinEncirclingModulus) highest = grid.omega[i];
    return kMinNodes + static_cast<int>(std::min(2 * highest * loop.plant().dead_time(), kMaxFurtherNodes));
}

/// The checks of the loop; `add_performance` adds those of its responses.
Verification verify(const Loop& loop, const Figure& Ms) {
    Verification v;
    const LoopGrid other = make_loop_grid(loop, 0.2, 17);
    v.ms_grid_difference = std::abs(find_sensitivity_peak(loop, other).value / Ms.value_or(HUGE_VAL) - 1);
    if (const auto pole = rightmost_pole(loop, nodes_for(loop, other))) v.stability_methods_agree = pole->real() < 0;
    return v;
}

/// Compares the integral of the load's error with its exact value.
void verify_integral(Verification& v, const StepResponse& load, const std::optional<double>& IAE, bool linear) {
    if (!IAE || !load.error_integral_final) return;
    const double exact = *load.error_integral_final;
    if (exact == 0) return;
    v.load_error_keeps_sign = *IAE == std::abs(exact);
    if (linear) v.ie_identity = std::abs(load.nodes.back().error_integral / exact - 1);
}

/// The threshold of the nonlinear integral; empty: the controller is linear.
std::optional<double> delta_r_of(const Controller& controller) {
    const auto* npid = std::get_if<Npid>(&controller);
    return npid != nullptr ? npid->delta_r : std::nullopt;
}

MeasuredResponse respond(const LinearPlant& plant, const Loop& loop, std::optional<double> delta_r,
                         const StepInputs& inputs, const EvaluateOptions& o) {
    ResponseOptions options;
    options.tolerance = kFinalTolerance;
    options.settled = kSettledForFigures;
    options.horizon = o.horizon;
    if (delta_r) {
        options.tolerance = kNonlinearTolerance;
        options.max_steps = kMaxNonlinearSteps;
    }
    ParallelPid acting = loop.gains();
    if (inputs.r == 0) acting.setpoint_lag = 0;
    const auto run = [&](const ResponseOptions& how) {
        if (delta_r) return simulate_npid(plant, acting, *delta_r, inputs, how);
        if (!o.actuator) return simulate_linear(plant, acting, inputs, how);
        return simulate_limited(plant, acting, inputs, {o.actuator->min, o.actuator->max}, how);
    };
    return measure(run, options, inputs.r);
}

/// Warns if the limits were reached.
void warn_of_limits(Evaluation& evaluation, const StepResponse& response, const ActuatorLimits& limits,
                    const char* step) {
    for (const auto& node : response.nodes) {
        if (node.u < limits.max && node.u > limits.min) continue;
        warn_of_limit(evaluation, step);
        return;
    }
}

/// Adds the time-domain figures to the evaluation of a stable loop.
void add_performance(Evaluation& evaluation, const LinearPlant& plant, const Loop& loop, const EvaluateOptions& o) {
    const auto delta_r = delta_r_of(evaluation.controller);
    MeasuredResponse of_setpoint = respond(plant, loop, delta_r, {o.setpoint_step, 0}, o),
                     of_load = respond(plant, loop, delta_r, {0, o.load_step}, o);
    const StepResponse &setpoint = of_setpoint.response, &load = of_load.response;
    const bool to_infinity = !o.horizon.has_value();
    evaluation.performance.setpoint = setpoint_figures(setpoint, o.setpoint_step, to_infinity, of_setpoint.indices);
    evaluation.performance.load = load_figures(load, to_infinity, of_load.indices);
    if (o.noise) evaluation.performance.noise = noise_figures(loop, *o.noise);
    evaluation.verification = verify(loop, evaluation.robustness.Ms);
    evaluation.verification.setpoint_errors = of_setpoint.errors;
    evaluation.verification.load_errors = of_load.errors;
    evaluation.verification.iae_step_halving = of_load.errors.IAE;
    if (to_infinity && !o.actuator)
        verify_integral(evaluation.verification, load, evaluation.performance.load.IAE, !delta_r);
    if (!is_accurate(of_setpoint) || !is_accurate(of_load))
        evaluation.warnings.push_back(
            {"coarse-figures",
             "Halving the time steps still changes an index by more than its promised accuracy, or could not be tried; "
             "verification has the change."});
    if (delta_r) {
        evaluation.nonlinear = nonlinear_figures(loop, *delta_r);
        warn_of_nonlinearity(evaluation, setpoint, load, o);
    } else if (o.actuator) {
        warn_of_limits(evaluation, setpoint, *o.actuator, "set-point");
        warn_of_limits(evaluation, load, *o.actuator, "load");
    }
    if (!setpoint.settles || !load.settles) warn_of_no_rest(evaluation);
    evaluation.responses =
        drawn(KnownResponse::of(std::move(of_setpoint.response)), KnownResponse::of(std::move(of_load.response)), o);
}

/// In percent, rounded down; never 0 or 100 unless it is exact.
std::string share(double fraction) {
    if (fraction > 0.999) return "more than 99.9 %";
    if (fraction < 0.001) return "less than 0.1 %";
    return text(std::floor(1000 * fraction + kCountRounding) / 10) + " %";
}

void add_region(Evaluation& evaluation, const PlantFamily& family) {
    evaluation.region = region_figures(family, gains(evaluation.controller));
    if (!evaluation.robustness.stable || evaluation.region->worst_Ms) return;
    evaluation.warnings.push_back(
        {"unstable-in-region",
         "The loop is stable on the nominal plant but not on all plants: " + share(evaluation.region->stable_fraction) +
             " of the evaluated plants are stable, worst_plant is not. Lower the limit on Ms, or "
             "use robust, which holds its limits on all of them."});
}

/// The frequencies that a plot must contain.
std::vector<double> marked(const Robustness& r) {
    std::vector<double> omega;
    for (const Figure& figure : {r.omega_Ms, r.omega_Mt, r.gain_crossover, r.phase_crossover})
        if (figure && *figure > 0) omega.push_back(*figure);
    std::ranges::sort(omega);
    return omega;
}

}  // namespace

Expected<Evaluation> evaluate_linear(const AnalysedLinear& subject, const Controller& controller,
                                     const EvaluateOptions& options) {
    if (auto error = refuse_evaluation(controller, options)) return *error;
    const auto loop = Loop::make(subject.nominal, gains(controller));
    if (!loop) return of_controller(loop.error());

    Evaluation evaluation = begun(controller, options);
    const StabilityCount count = count_unstable_poles(*loop);
    const LoopGrid grid = make_peak_grid(*loop);
    if (count.stable()) {
        evaluation.robustness = robustness_of(*loop, grid);
        if (auto error = stopped(options)) return *error;
        add_performance(evaluation, subject.nominal, *loop, options);
    } else {
        mark_unstable(evaluation, count);
    }
    if (options.points >= 2)
        evaluation.frequency = frequency_traces(*loop, grid, options.points, marked(evaluation.robustness));
    if (auto error = stopped(options)) return *error;
    if (!subject.family.single()) add_region(evaluation, subject.family);
    return evaluation;
}

Figure load_IAE(const LinearPlant& plant, const Controller& controller, const EvaluateOptions& options) {
    const auto loop = Loop::make(plant, gains(controller));
    if (!loop) return no_figure(loop.error().message);
    const MeasuredResponse load = respond(plant, *loop, delta_r_of(controller), {0, options.load_step}, options);
    return load_figures(load.response, !options.horizon, load.indices).IAE;
}

namespace {

constexpr const char* kNoTime =
    "The plant is known only by points of its frequency response, so its response over time is unknown.";

}  // namespace

Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options) {
    if (auto error = refuse_evaluation(controller, options)) return *error;
    const auto loop = MeasuredLoop::make(plant, gains(controller));
    if (!loop) return of_controller(loop.error());

    Evaluation evaluation = begun(controller, options);
    evaluation.performance = no_performance(kNoTime);
    if (options.noise) evaluation.performance.noise = NoisePerformance{no_figure(kNoTime), no_figure(kNoTime)};
    const StabilityCount count = count_unstable_poles(*loop);
    const LoopGrid grid = make_loop_grid(*loop);
    if (count.stable())
        evaluation.robustness = robustness_of(*loop, grid);
    else
        mark_unstable(evaluation, count);
    if (std::holds_alternative<Npid>(controller)) warn_of_linear_part(evaluation);
    if (options.points >= 2) evaluation.frequency = frequency_traces(grid, options.points);
    return evaluation;
}

namespace {

constexpr double kStallLevel = 1.5;  // multiple of delta_r: the integral acts on less than a third of the error

std::string statement_of(const IntegralSector& sector, const NonlinearFigures& figures) {
    if (sector.absolutely_stable())
        return std::string("The ") + (sector.circle_criterion ? "circle" : "Popov") +
               " criterion holds for the integral's gain in (0, 1]: every error decays to 0 for all step sizes and "
               "every delta_r.";
    if (!sector.stable_without_integral)
        return "Without integral action the loop is unstable, and for large errors the integral hardly acts: they may "
               "grow. Ms and the margins hold for small errors only.";
    if (figures.limit_cycle_predicted)
        return "Neither criterion holds, and the describing function predicts an oscillation that grows beyond an "
               "amplitude of about " +
               text(*figures.limit_cycle_amplitude) + ": keep errors well below it.";
    if (!sector.stable_for_every_gain)
        return "Neither criterion holds, and with a weak integral the loop is unstable. Ms and the margins hold for "
               "small errors only.";
    return "Neither the circle nor the Popov criterion holds, so stability for large errors is not proven; the "
           "describing function predicts no oscillation. Ms and the margins hold for small errors.";
}

void warn_of_stall(Evaluation& evaluation, const char* step, double largest_error, double delta_r) {
    if (largest_error <= kStallLevel * delta_r) return;
    const double share = std::exp(-0.5 * std::pow(largest_error / delta_r, 2));
    evaluation.warnings.push_back(
        {"integral-stalls", std::string("The ") + step + " step makes the error " + text(largest_error) +
                                ", beyond 1.5 delta_r = " + text(kStallLevel * delta_r) + ": the integral acts on " +
                                text(100 * share) +
                                " % of it there and hardly changes until P and D action have reduced the error. A "
                                "larger delta_r or the linear PID recovers faster."});
}

}  // namespace

NonlinearFigures nonlinear_figures(const Loop& linear_part, double delta_r) {
    const IntegralSector sector = judge_integral_sector(linear_part);
    NonlinearFigures figures;
    figures.delta_r = delta_r;
    figures.stable_without_integral = sector.stable_without_integral;
    figures.circle_criterion = sector.circle_criterion;
    figures.popov_criterion = sector.popov_criterion;
    figures.popov_q = Figure(sector.popov_q, "No q satisfies Popov's condition.");
    figures.limit_cycle_predicted = sector.critical_gain.has_value();
    if (sector.critical_gain) {
        figures.limit_cycle_amplitude = ErrorScaling{delta_r}.amplitude_of_gain(*sector.critical_gain);
        figures.limit_cycle_omega = sector.critical_omega;
    } else {
        figures.limit_cycle_amplitude = figures.limit_cycle_omega = no_figure("No oscillation is predicted.");
    }
    figures.statement = statement_of(sector, figures);
    return figures;
}

void warn_of_linear_part(Evaluation& evaluation) {
    evaluation.warnings.push_back(
        {"linear-part",
         "Ms, Mt, Mks, the margins, frequency curves and noise figures belong to the linear part of this nonlinear "
         "PID, which it follows while the error is much smaller than delta_r."});
}

void warn_of_nonlinearity(Evaluation& evaluation, const StepResponse& setpoint, const StepResponse& load,
                          const EvaluateOptions& options) {
    const double delta_r = evaluation.nonlinear->delta_r;
    warn_of_linear_part(evaluation);
    evaluation.warnings.push_back(
        {"depends-on-step-size",
         "The responses are not proportional to the steps: these hold for a set-point step of " +
             text(options.setpoint_step) + " and a load step of " + text(options.load_step) +
             " with delta_r = " + text(delta_r) + "."});
    const Extremes of_setpoint = extremes_of_y(setpoint.nodes), of_load = extremes_of_y(load.nodes);
    const double r = options.setpoint_step;
    warn_of_stall(evaluation, "set-point",
                  std::max({std::abs(r), std::abs(r - of_setpoint.max), std::abs(r - of_setpoint.min)}), delta_r);
    warn_of_stall(evaluation, "load", std::max(std::abs(of_load.max), std::abs(of_load.min)), delta_r);
    if (options.actuator)
        evaluation.warnings.push_back(
            {"limits-not-applied", "The nonlinear PID is simulated without the actuator's limits; u may exceed them."});
}

}  // namespace tunewright
