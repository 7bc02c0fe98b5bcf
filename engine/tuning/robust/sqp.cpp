#include "engine/tuning/robust/sqp.h"

#include <algorithm>
#include <cmath>

#include "engine/loop/measured_loop.h"
#include "engine/loop/stability.h"
#include "engine/tuning/robust/quadratic_program.h"

namespace tunewright::robust {
namespace {

constexpr double kNear = -0.25;     // constraints below it cannot become active within a step
constexpr double kAimBelow = 1e-7;  // feasibility is aimed this far inside
constexpr double kFeasible = 1e-8;  // and accepted with this much slack

Vector3 difference(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector3 times(const Matrix3& H, const Vector3& v) { return {dot(H[0], v), dot(H[1], v), dot(H[2], v)}; }
double longest(const Vector3& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

DesignPoint moved(const DesignPoint& x, const Vector3& p) { return {x[0] + p[0], x[1] + p[1], x[2] + p[2]}; }

/// BFGS on the Lagrangian with Powell's damping: stays positive definite where the constraints' curvature is not.
void update(Matrix3& H, const Vector3& step, Vector3 y, int n) {
    const Vector3 Hs = times(H, step);
    const double sHs = dot(step, Hs), sy = dot(step, y);
    if (!(sHs > 1e-300)) return;
    if (sy < 0.2 * sHs) {
        const double theta = 0.8 * sHs / (sHs - sy);
        for (std::size_t i = 0; i < 3; ++i) y[i] = theta * y[i] + (1 - theta) * Hs[i];
    }
    const double scale = dot(step, y);
    if (!(scale > 1e-300)) return;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            H[std::size_t(i)][std::size_t(j)] +=
                y[std::size_t(i)] * y[std::size_t(j)] / scale - Hs[std::size_t(i)] * Hs[std::size_t(j)] / sHs;
}

/// The peaks' linear models and the trust region, which ends at the bounds of Ti and Td, for a step from x.
std::vector<LinearConstraint> linearised(const std::vector<ActivePeak>& peaks, const Sweep& sweep, const DesignPoint& x,
                                         double radius, std::size_t most) {
    std::vector<LinearConstraint> constraints;
    for (const auto& peak : peaks) {
        if (constraints.size() == most) break;
        constraints.push_back({peak.gradient, -peak.value - kAimBelow});
    }
    const auto log_time = [&](double in_reference) { return std::log(in_reference / sweep.reference()); };
    const std::array<double, 3> lowest = {-INFINITY, log_time(kMinTi), log_time(kMinTd)};
    const std::array<double, 3> highest = {INFINITY, INFINITY, log_time(kMaxTd)};
    for (std::size_t i = 0; i < std::size_t(sweep.problem().dimension()); ++i) {
        Vector3 up{}, down{};
        up[i] = 1;
        down[i] = -1;
        constraints.push_back({up, std::clamp(highest[i] - x[i], 0.0, radius)});
        constraints.push_back({down, std::clamp(x[i] - lowest[i], 0.0, radius)});
    }
    return constraints;
}

/// The gradient, at the new point, of the peak that was `old`.
Vector3 followed(const std::vector<ActivePeak>& peaks, const ActivePeak& old) {
    const ActivePeak* best = nullptr;
    for (const auto& peak : peaks)
        if (peak.kind == old.kind && peak.plant == old.plant &&
            (best == nullptr ||
             std::abs(std::log(peak.omega / old.omega)) < std::abs(std::log(best->omega / old.omega))))
            best = &peak;
    const bool same =
        best != nullptr && (best->omega == old.omega || std::abs(std::log(best->omega / old.omega)) < 0.3);
    return same ? best->gradient : old.gradient;
}

}  // namespace

bool is_stable(const DesignProblem& problem, const DesignPoint& x) {
    const ParallelPid gains = to_parallel(controller_at(problem, x));
    if (problem.measured) {
        const auto loop = MeasuredLoop::make(*problem.measured, gains);
        return loop && !loop->band_too_short() && loop->count_unstable_poles().stable();
    }
    for (std::size_t i = 0; i < problem.plants(); ++i) {
        const auto loop = Loop::make(problem.plant_at(i), gains);
        if (!loop || !count_unstable_poles(*loop).stable()) return false;
    }
    return true;
}

std::optional<DesignPoint> restore(const Sweep& sweep, DesignPoint x) {
    const int n = sweep.problem().dimension();
    Matrix3 identity{};
    for (std::size_t i = 0; i < 3; ++i) identity[i][i] = 1;
    for (int k = 0; k < 12; ++k) {
        const auto peaks = sweep.peaks(x, -0.1);
        if (peaks.empty() || peaks[0].value <= -kFeasible / 10) return x;
        const auto step = solve_quadratic_program(n, identity, {}, linearised(peaks, sweep, x, 0.5, 6));
        if (step) {
            x = moved(x, step->p);
        } else {
            x[0] -= std::min(0.3, std::max(1e-6, 1.5 * peaks[0].value));  // no common linear way out: less gain
        }
    }
    const auto peaks = sweep.peaks(x, -0.1);
    if (peaks.empty() || peaks[0].value <= kFeasible) return x;
    return std::nullopt;
}

SqpResult minimise(const Sweep& sweep, const DesignProblem& problem, const DesignPoint& start,
                   const SqpOptions& options, const Report& report) {
    const int n = problem.dimension();
    SqpResult result;
    result.x = restore(sweep, start).value_or(start);
    CostWithGradient cost = log_cost_with_gradient(problem, result.x, options.simulation_tolerance);
    result.log_cost = cost.value;
    if (!std::isfinite(cost.value)) return result;
    std::vector<ActivePeak> peaks = sweep.peaks(result.x, kNear);
    Matrix3 H{};
    for (std::size_t i = 0; i < 3; ++i) H[i][i] = 0.3;
    double radius = options.trust_radius;
    int small_steps = 0;
    for (; result.iterations < options.max_iterations; ++result.iterations) {
        const auto constraints = linearised(peaks, sweep, result.x, radius, 8);
        const auto step = solve_quadratic_program(n, H, cost.gradient, constraints);
        if (!step) {
            radius *= 2;
            if (radius > 4) break;
            continue;
        }
        const double promised = -(dot(cost.gradient, step->p) + 0.5 * dot(step->p, times(H, step->p)));
        if (promised < options.cost_tolerance) {
            result.converged = true;
            break;
        }
        // Back to the curved constraints before the cost is asked: a sweep costs a tenth of a simulation.
        const auto candidate = restore(sweep, moved(result.x, step->p));
        double candidate_cost = INFINITY;
        if (candidate && longest(difference(*candidate, result.x)) < 4 * radius && is_stable(problem, *candidate))
            candidate_cost = log_cost(problem, *candidate, options.simulation_tolerance);
        const double won = cost.value - candidate_cost;
        if (!(won > 0.05 * promised)) {
            radius = std::min(radius, longest(step->p)) * 0.3;
            if (radius < 1e-5) break;
            continue;
        }
        if (won > 0.7 * promised) radius = std::min(2 * radius, 1.0);
        const CostWithGradient next = log_cost_with_gradient(problem, *candidate, options.simulation_tolerance);
        const auto next_peaks = sweep.peaks(*candidate, kNear);
        Vector3 y = difference(next.gradient, cost.gradient);
        for (std::size_t i = 0; i < std::min<std::size_t>(peaks.size(), 8); ++i) {
            const double lambda = step->multipliers[i];
            if (lambda == 0) continue;
            const Vector3 change = difference(followed(next_peaks, peaks[i]), peaks[i].gradient);
            for (std::size_t k = 0; k < 3; ++k) y[k] += lambda * change[k];
        }
        update(H, difference(*candidate, result.x), y, n);
        result.x = *candidate;
        cost = next;
        result.log_cost = cost.value;
        peaks = next_peaks;
        if (report && !report(result.x, cost.value)) break;
        small_steps = won < options.cost_tolerance ? small_steps + 1 : 0;
        if (small_steps >= 2) {
            result.converged = true;
            break;
        }
    }
    return result;
}

}  // namespace tunewright::robust
