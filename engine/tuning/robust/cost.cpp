#include "engine/tuning/robust/cost.h"

#include <limits>

#include "engine/simulation/linear/indices.h"

namespace tunewright::robust {
namespace {

constexpr double kSettled = 1e-4;     // the tail beyond it is closed by the exact integral of error
constexpr double kDifference = 1e-5;  // of a logarithm: noise 1e-13/1e-5, curvature error 1e-5
constexpr int kMaxSteps = 12000;      // a design that needs more is no candidate

struct CostRun {
    double IAE = std::numeric_limits<double>::infinity();
    StepSchedule schedule;
};

CostRun run(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance,
            const StepSchedule* repeat) {
    ResponseOptions options;
    options.tolerance = tolerance;
    options.settled = kSettled;
    options.max_steps = kMaxSteps;
    options.repeat = repeat;
    const StepInputs inputs{setpoint ? 1.0 : 0.0, setpoint ? 0.0 : 1.0};
    StepResponse response = simulate_linear(*problem.plant, to_parallel(controller_at(problem, x)), inputs, options);
    CostRun result;
    if (!response.settles || !response.error_integral_final) return result;
    result.IAE = integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final);
    result.schedule = std::move(response.schedule);
    return result;
}

/// ln of one IAE with its gradient.
CostWithGradient log_iae(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance) {
    const CostRun base = run(problem, x, setpoint, tolerance, nullptr);
    CostWithGradient result{std::log(base.IAE), {}};
    if (!std::isfinite(result.value)) return result;
    for (int i = 0; i < problem.dimension(); ++i) {
        DesignPoint moved = x;
        moved[static_cast<std::size_t>(i)] += kDifference;
        const CostRun other = run(problem, moved, setpoint, tolerance, &base.schedule);
        result.gradient[static_cast<std::size_t>(i)] = (std::log(other.IAE) - result.value) / kDifference;
    }
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
    switch (problem.objective) {
        case Objective::load_ie: return x[1] - x[0];
        case Objective::load_iae: return std::log(run(problem, x, false, tolerance, nullptr).IAE);
        case Objective::setpoint_iae: return std::log(run(problem, x, true, tolerance, nullptr).IAE);
        case Objective::weighted:
            return std::log(mixed(problem, run(problem, x, false, tolerance, nullptr).IAE,
                                  run(problem, x, true, tolerance, nullptr).IAE));
    }
    return std::numeric_limits<double>::infinity();
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

CostWithGradient log_cost_with_gradient(const DesignProblem& problem, const DesignPoint& x, double tolerance) {
    switch (problem.objective) {
        case Objective::load_ie: return {x[1] - x[0], {-1, 1, 0}};
        case Objective::load_iae: return log_iae(problem, x, false, tolerance);
        case Objective::setpoint_iae: return log_iae(problem, x, true, tolerance);
        case Objective::weighted: break;
    }
    const CostWithGradient load = log_iae(problem, x, false, tolerance),
                           setpoint = log_iae(problem, x, true, tolerance);
    const double a = problem.rho * std::exp(load.value) / problem.load_optimum;
    const double b = (1 - problem.rho) * std::exp(setpoint.value) / problem.setpoint_optimum;
    CostWithGradient result{std::log(a + b), {}};
    for (std::size_t i = 0; i < 3; ++i)
        result.gradient[i] = (a * load.gradient[i] + b * setpoint.gradient[i]) / (a + b);
    return result;
}

}  // namespace tunewright::robust
