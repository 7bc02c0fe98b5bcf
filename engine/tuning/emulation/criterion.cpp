#include "engine/tuning/emulation/criterion.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/simulation/nonlinear/nonlinear_response.h"

namespace tunewright::emulation {

namespace {

constexpr double kEarlyEndPenalty = 100;  // factor of the J at rest, for a run that ends early
constexpr double kMaxPenalisedJ = 1e100;  // of a penalised J
constexpr int kMaxSimulationSteps = 20000;

}  // namespace

Criterion::Criterion(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories)
    : problem_(problem), trajectories_(trajectories), weights_(simpson_weights(problem)) {
    for (const Trajectory& trajectory : trajectories)
        at_rest_ += (problem.wy * trajectory.y_size + problem.wu * trajectory.u_size) /
                    static_cast<double>(trajectories.size());
}

PidRun Criterion::run(std::size_t scenario, const IdealPid& pid, double tolerance, const std::stop_token& stop) const {
    const Scenario& asked = problem_.scenarios[scenario];
    NonlinearOptions options;
    options.tolerance = tolerance;
    options.horizon = problem_.horizon;
    options.max_steps = kMaxSimulationSteps;
    options.initial = asked.x0;
    options.samples = problem_.intervals + 1;
    options.nodes = false;
    options.stop = stop;
    auto response = simulate_nonlinear(*asked.system, to_parallel(pid), {.r = asked.setpoint_step}, options);
    return {std::move(response.even.y), std::move(response.even.u), std::min(1.0, response.t_end / problem_.horizon),
            std::move(response.ended)};
}

Cost Criterion::weigh(const IdealPid& pid, double tolerance, const std::stop_token& stop,
                      std::vector<double>* residuals) const {
    Cost cost;
    if (residuals != nullptr) residuals->clear();
    const double share = 1 / static_cast<double>(trajectories_.size());
    for (std::size_t i = 0; i < trajectories_.size(); ++i) {
        const Trajectory& asked = trajectories_[i];
        const PidRun done = run(i, pid, tolerance, stop);
        for (std::size_t k = 0; k < std::min(done.y.size(), weights_.size()); ++k) {
            const double dy = asked.y_nl[k] - done.y[k], du = asked.u_nl[k] - done.u[k], w = share * weights_[k];
            cost.J_y += w * dy * dy;
            cost.J_u += w * du * du;
            if (residuals == nullptr) continue;
            if (problem_.wy > 0) residuals->push_back(std::sqrt(problem_.wy * w) * dy);
            if (problem_.wu > 0) residuals->push_back(std::sqrt(problem_.wu * w) * du);
        }
        if (done.ended.empty() || done.share >= cost.share) continue;
        cost.share = done.share;
        cost.ended = done.ended;
    }
    cost.J = problem_.wy * cost.J_y + problem_.wu * cost.J_u;
    return cost;
}

double Criterion::penalised(const Cost& cost) const {
    const double early = cost.ended.empty() ? 0 : kEarlyEndPenalty * at_rest_ * (2 - cost.share);
    return std::isfinite(cost.J) ? std::min(cost.J + early, kMaxPenalisedJ) : kMaxPenalisedJ;
}

namespace {

double square_integral(const std::vector<double>& values, const std::vector<double>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights[i] * values[i] * values[i];
    return sum;
}

Error cannot_run(std::size_t scenario, const std::string& reason) {
    return {ErrorKind::unsupported, "scenarios/" + std::to_string(scenario),
            "The nonlinear controller itself cannot perform this step: " + reason +
                " Use a smaller step, a slower target or wider limits of the input."};
}

}  // namespace

std::vector<double> simpson_weights(const EmulationProblem& problem) {
    const double third = problem.horizon / problem.intervals / 3;
    const auto intervals = static_cast<std::size_t>(problem.intervals);
    std::vector<double> weights(intervals + 1, 2 * third);
    for (std::size_t i = 1; i < intervals; i += 2) weights[i] = 4 * third;
    weights.front() = weights.back() = third;
    return weights;
}

Expected<std::vector<Trajectory>> nonlinear_trajectories(const EmulationProblem& problem, const RunControl& control) {
    const std::vector<double> weights = simpson_weights(problem);
    std::vector<Trajectory> trajectories;
    for (std::size_t i = 0; i < problem.scenarios.size(); ++i) {
        const Scenario& scenario = problem.scenarios[i];
        const auto run = simulate_linearising(
            *scenario.system, problem.target, scenario.setpoint_step,
            {.horizon = problem.horizon, .samples = problem.intervals + 1, .initial = scenario.x0}, control);
        if (control.stop.stop_requested())
            return Error{ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
        if (!run.ended.empty()) return cannot_run(i, run.ended);
        Trajectory trajectory{run.even.y, run.even.u, 0, 0, run.limited};
        trajectory.y_size = square_integral(trajectory.y_nl, weights);
        trajectory.u_size = square_integral(trajectory.u_nl, weights);
        trajectories.push_back(std::move(trajectory));
    }
    return trajectories;
}

}  // namespace tunewright::emulation
