#include "engine/tuning/robust/cost.h"

#include <limits>
#include <span>

#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/neighbouring_runs.h"

namespace tunewright::robust {
namespace {

constexpr double kSettledTolerance = 1e-4;   // the tail after it is known from the exact integral of the error
constexpr double kLogDifferenceStep = 1e-5;  // of a logarithm: error by noise 1e-13/1e-5, by curvature 1e-5
constexpr int kMaxSteps = 12000;             // a design that needs more steps is not a candidate

constexpr std::array<double, 3> kOfIntegratedError = {-1, 1, 0};  // of ln(Ti/Kp)

struct CostRun {
    double IAE = std::numeric_limits<double>::infinity();
    bool keeps_sign = false;  // the error
    StepResponse response;
};

StepInputs inputs_of(bool setpoint) { return {setpoint ? 1.0 : 0.0, setpoint ? 0.0 : 1.0}; }

CostRun run(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance,
            const StepSchedule* repeat) {
    ResponseOptions options;
    options.tolerance = tolerance;
    options.settled = kSettledTolerance;
    options.max_steps = kMaxSteps;
    options.repeat = repeat;
    const StepInputs inputs = inputs_of(setpoint);
    CostRun result;
    result.response = simulate_linear(*problem.plant, to_parallel(controller_at(problem, x)), inputs, options);
    const StepResponse& response = result.response;
    if (!response.settles || !response.error_integral_final) return result;
    result.IAE = integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final);
    result.keeps_sign = result.IAE == std::abs(*response.error_integral_final);
    return result;
}

double mixed(const DesignProblem& problem, double load, double setpoint) {
    return problem.rho * load / problem.load_optimum + (1 - problem.rho) * setpoint / problem.setpoint_optimum;
}

}  // namespace

std::optional<double> step_iae(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance) {
    const double IAE = run(problem, x, setpoint, tolerance, nullptr).IAE;
    return std::isfinite(IAE) ? std::optional<double>(IAE) : std::nullopt;
}

double log_cost(const DesignProblem& problem, const DesignPoint& x, double tolerance) {
    return EvaluatedDesign(problem, x, tolerance).log_cost();
}

double log_cost_bound(const DesignProblem& problem, const DesignPoint& x) {
    const double load = x[1] - x[0];
    if (problem.objective == Objective::load_ie || problem.objective == Objective::load_iae) return load;
    const double Tf = filter_time(problem, std::exp(x[2]));
    const double without_filter =
        problem.plant->integrators() > 0 ? 0 : std::exp(load) / std::abs(problem.plant->low_frequency_gain());
    const double setpoint = std::abs(without_filter - Tf);
    if (problem.objective == Objective::setpoint_iae) return std::log(setpoint);
    return std::log(mixed(problem, std::exp(load), setpoint));
}

EvaluatedDesign::EvaluatedDesign(const DesignProblem& problem, const DesignPoint& x, double tolerance)
    : problem_(&problem), x_(x), tolerance_(tolerance) {
    const Objective objective = problem.objective;
    if (objective == Objective::load_ie) {
        log_cost_ = x[1] - x[0];
        return;
    }
    if (objective != Objective::setpoint_iae) load_ = evaluated(false);
    if (objective != Objective::load_iae) setpoint_ = evaluated(true);
    log_cost_ = objective == Objective::load_iae ? load_.log_iae
                : objective == Objective::setpoint_iae
                    ? setpoint_.log_iae
                    : std::log(mixed(problem, std::exp(load_.log_iae), std::exp(setpoint_.log_iae)));
}

EvaluatedDesign::Part EvaluatedDesign::evaluated(bool setpoint) const {
    CostRun done = run(*problem_, x_, setpoint, tolerance_, nullptr);
    return {std::log(done.IAE), done.keeps_sign, std::move(done.response)};
}

std::array<double, 3> EvaluatedDesign::gradient_of(const Part& part, bool setpoint) const {
    if (part.keeps_sign && !setpoint) return kOfIntegratedError;
    const auto n = static_cast<std::size_t>(problem_->dimension());
    std::array<DesignPoint, 3> moved;
    std::array<ParallelPid, 3> controllers;
    for (std::size_t i = 0; i < n; ++i) {
        moved[i] = x_;
        moved[i][i] += kLogDifferenceStep;
        controllers[i] = to_parallel(controller_at(*problem_, moved[i]));
    }
    const auto together =
        neighbouring_iaes(*problem_->plant, std::span(controllers).first(n), inputs_of(setpoint), part.response);
    std::array<double, 3> gradient{};
    for (std::size_t i = 0; i < n; ++i) {
        const double IAE =
            together ? (*together)[i] : run(*problem_, moved[i], setpoint, tolerance_, &part.response.schedule).IAE;
        gradient[i] = (std::log(IAE) - part.log_iae) / kLogDifferenceStep;
    }
    return gradient;
}

std::array<double, 3> EvaluatedDesign::gradient() const {
    switch (problem_->objective) {
        case Objective::load_ie: return kOfIntegratedError;
        case Objective::load_iae: return gradient_of(load_, false);
        case Objective::setpoint_iae: return gradient_of(setpoint_, true);
        case Objective::weighted: break;
    }
    const auto load = gradient_of(load_, false), setpoint = gradient_of(setpoint_, true);
    const double a = problem_->rho * std::exp(load_.log_iae) / problem_->load_optimum;
    const double b = (1 - problem_->rho) * std::exp(setpoint_.log_iae) / problem_->setpoint_optimum;
    std::array<double, 3> gradient{};
    for (std::size_t i = 0; i < 3; ++i) gradient[i] = (a * load[i] + b * setpoint[i]) / (a + b);
    return gradient;
}

CostWithGradient EvaluatedDesign::with_gradient() const {
    if (!std::isfinite(log_cost_)) return {log_cost_, {}};
    return {log_cost_, gradient()};
}

}  // namespace tunewright::robust
