#include "engine/tuning/emulation/search/criterion.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation/nonlinear/nonlinear_response.h"

namespace tunewright::emulation {
namespace {

constexpr double kPenalty = 100;    // of a run that ends early, in J at rest
constexpr double kLargest = 1e100;  // of a penalised J
constexpr int kMaxSteps = 20000;

}  // namespace

Criterion::Criterion(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories)
    : problem_(problem), trajectories_(trajectories), weights_(simpson_weights(problem)) {
    for (const Trajectory& trajectory : trajectories)
        at_rest_ += (problem.wy * trajectory.y_size + problem.wu * trajectory.u_size) /
                    static_cast<double>(trajectories.size());
}

PidRun Criterion::run(std::size_t scenario, const Pid& pid, double tolerance, const std::stop_token& stop) const {
    const Scenario& asked = problem_.scenarios[scenario];
    NonlinearOptions options;
    options.tolerance = tolerance;
    options.horizon = problem_.horizon;
    options.max_steps = kMaxSteps;
    options.initial = asked.x0;
    options.samples = problem_.intervals + 1;
    options.nodes = false;
    options.stop = stop;
    auto response = simulate_nonlinear(*asked.system, to_parallel(pid), {.r = asked.setpoint_step}, options);
    return {std::move(response.even.y), std::move(response.even.u), std::min(1.0, response.t_end / problem_.horizon),
            std::move(response.ended)};
}

Cost Criterion::weigh(const Pid& pid, double tolerance, const std::stop_token& stop,
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
    const double early = cost.ended.empty() ? 0 : kPenalty * at_rest_ * (2 - cost.share);
    return std::isfinite(cost.J) ? std::min(cost.J + early, kLargest) : kLargest;
}

}  // namespace tunewright::emulation
