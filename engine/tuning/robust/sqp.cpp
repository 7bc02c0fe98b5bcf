#include "engine/tuning/robust/sqp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/loop/measured_loop.h"
#include "engine/loop/stability.h"
#include "engine/tuning/robust/quadratic_program.h"

namespace tunewright::robust {
namespace {

constexpr double kNear = -0.25;     // constraints below it cannot become active within a step
constexpr double kAimBelow = 1e-7;  // feasibility is aimed this far inside
constexpr double kFeasible = 1e-8;  // and accepted with this much slack

constexpr int kMaxRestoring = 12;           // Newton steps back to the feasible side; three or four are usual
constexpr double kNearOfRestoring = -0.1;   // constraints below it do not stop a step back
constexpr double kRestoringRadius = 0.5;    // of a logarithm
constexpr std::size_t kRestoringPeaks = 6;  // the largest ones, as constraints of a step back
constexpr double kMinLessGain = 1e-6;       // ln: less gain where the peaks have no common linear way out
constexpr double kMaxLessGain = 0.3;
constexpr std::size_t kPeaks = 8;           // the largest ones, as constraints of a step
constexpr double kFirstCurvature = 0.3;     // of ln(cost) over logarithms, before gradients have shown it
constexpr double kLeastCurvature = 1e-300;  // of a step whose update would divide by nothing
constexpr double kPowellDamping = 0.2;      // of s.H s, which s.y keeps at least (Powell 1978)
constexpr double kSamePeak = 0.3;           // ln omega: a peak that moves further is another one
constexpr int kSmallStepsToEnd = 2;         // in a row, each within the tolerance of the cost
constexpr double kEnoughWon = 0.05;         // of what the model promised, for a step to be taken
constexpr double kMostOfPromise = 5;        // a run rarely wins so many times what its model promises
constexpr double kMuchWon = 0.7;            // of it, for the trust region to grow
constexpr double kTellingStep = 1e-3;       // of a logarithm: a curvature from shorter ones is not handed on
constexpr double kSmallestRadius = 1e-5;    // of a logarithm: nothing is left to win in it
constexpr double kLargestRadius = 4;        // beyond it the linear models have no common solution at all
constexpr double kFarRestored = 4;          // radii: what restoring moved further is another design

double longest(const Vector3& v) { return v.cwiseAbs().maxCoeff(); }
Vector3 vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
Vector3 difference(const std::array<double, 3>& a, const std::array<double, 3>& b) { return vector(a) - vector(b); }
DesignPoint moved(const DesignPoint& x, const Vector3& p) { return {x[0] + p[0], x[1] + p[1], x[2] + p[2]}; }

Matrix3 matrix(const Curvature& curvature) {
    Matrix3 H;
    for (std::size_t i = 0; i < 3; ++i) H.row(static_cast<Eigen::Index>(i)) = vector(curvature[i]);
    return H;
}

Curvature curvature(const Matrix3& H) {
    Curvature rows;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) rows[i][j] = H(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return rows;
}

/// BFGS on the Lagrangian with Powell's damping: stays positive definite where the constraints' curvature is not.
void update(Matrix3& H, const Vector3& step, Vector3 y, int n) {
    const Vector3 Hs = H * step;
    const double sHs = step.dot(Hs), sy = step.dot(y);
    if (!(sHs > kLeastCurvature)) return;
    if (sy < kPowellDamping * sHs) {
        const double theta = (1 - kPowellDamping) * sHs / (sHs - sy);
        y = theta * y + (1 - theta) * Hs;
    }
    const double scale = step.dot(y);
    if (!(scale > kLeastCurvature)) return;
    H.topLeftCorner(n, n) += (y * y.transpose() / scale - Hs * Hs.transpose() / sHs).topLeftCorner(n, n);
}

/// The peaks' linear models and the trust region, which ends at the bounds of Ti and Td, for a step from x.
std::vector<LinearConstraint> linearised(const std::vector<ActivePeak>& peaks, const Sweep& sweep, const DesignPoint& x,
                                         double radius, std::size_t most) {
    std::vector<LinearConstraint> constraints;
    for (const auto& peak : peaks) {
        if (constraints.size() == most) break;
        constraints.push_back({vector(peak.gradient), -peak.value - kAimBelow});
    }
    const auto log_time = [&](double in_reference) { return std::log(in_reference / sweep.reference()); };
    const std::array<double, 3> lowest = {-INFINITY, log_time(kMinTi), log_time(kMinTd)};
    const std::array<double, 3> highest = {INFINITY, INFINITY, log_time(kMaxTd)};
    for (std::size_t i = 0; i < std::size_t(sweep.problem().dimension()); ++i) {
        const Vector3 up = Vector3::Unit(static_cast<Eigen::Index>(i));
        constraints.push_back({up, std::clamp(highest[i] - x[i], 0.0, radius)});
        constraints.push_back({-up, std::clamp(x[i] - lowest[i], 0.0, radius)});
    }
    return constraints;
}

/// The gradient, at the new point, of the peak that was `old`.
const std::array<double, 3>& followed(const std::vector<ActivePeak>& peaks, const ActivePeak& old) {
    const ActivePeak* best = nullptr;
    for (const auto& peak : peaks)
        if (peak.kind == old.kind && peak.plant == old.plant &&
            (best == nullptr ||
             std::abs(std::log(peak.omega / old.omega)) < std::abs(std::log(best->omega / old.omega))))
            best = &peak;
    const bool same =
        best != nullptr && (best->omega == old.omega || std::abs(std::log(best->omega / old.omega)) < kSamePeak);
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

namespace {

/// A design within the limits, and its peaks above kNear.
struct Restored {
    DesignPoint x;
    std::vector<ActivePeak> peaks;
};

std::optional<Restored> restored(const Sweep& sweep, DesignPoint x) {
    const int n = sweep.problem().dimension();
    for (int k = 0; k < kMaxRestoring; ++k) {
        auto peaks = sweep.peaks(x, kNear);
        if (peaks.empty() || peaks[0].value <= -kFeasible / 10) return Restored{x, std::move(peaks)};
        const auto in_the_way =
            std::ranges::count_if(peaks, [](const ActivePeak& peak) { return peak.value > kNearOfRestoring; });
        const auto step = solve_quadratic_program(
            n, Matrix3::Identity(), Vector3::Zero(),
            linearised(peaks, sweep, x, kRestoringRadius, std::min(kRestoringPeaks, std::size_t(in_the_way))));
        if (step) {
            x = moved(x, step->p);
        } else {
            x[0] -=
                std::clamp(1.5 * peaks[0].value, kMinLessGain, kMaxLessGain);  // no common linear way out: less gain
        }
    }
    auto peaks = sweep.peaks(x, kNear);
    if (peaks.empty() || peaks[0].value <= kFeasible) return Restored{x, std::move(peaks)};
    return std::nullopt;
}

}  // namespace

std::optional<DesignPoint> restore(const Sweep& sweep, DesignPoint x) {
    const auto found = restored(sweep, x);
    return found ? std::optional(found->x) : std::nullopt;
}

std::optional<DesignPoint> feasible_near(const Sweep& sweep, const DesignPoint& x) {
    auto moved = restore(sweep, x);
    return moved && is_stable(sweep.problem(), *moved) ? moved : std::nullopt;
}

SqpResult minimise(const Sweep& sweep, const DesignProblem& problem, const DesignPoint& start,
                   const SqpOptions& options, const Report& report) {
    const int n = problem.dimension();
    SqpResult result;
    auto here = restored(sweep, start);
    result.x = here ? here->x : start;
    CostWithGradient cost = PricedDesign(problem, result.x, options.simulation_tolerance).with_gradient();
    result.log_cost = cost.value;
    if (!std::isfinite(cost.value)) return result;
    std::vector<ActivePeak> peaks = here ? std::move(here->peaks) : sweep.peaks(result.x, kNear);
    Matrix3 H = options.curvature ? matrix(*options.curvature) : Matrix3(kFirstCurvature * Matrix3::Identity());
    double radius = options.trust_radius;
    int small_steps = 0;
    std::optional<DesignPoint> stable;  // the last design whose loop was seen to be stable
    if (options.stable_start) stable = start;
    const auto stays_stable = [&](const DesignPoint& x) {
        return (stable && sweep.stays_stable(*stable, x)) || is_stable(problem, x);
    };
    for (; result.iterations < options.max_iterations; ++result.iterations) {
        const auto constraints = linearised(peaks, sweep, result.x, radius, kPeaks);
        const auto step = solve_quadratic_program(n, H, vector(cost.gradient), constraints);
        if (!step) {
            radius *= 2;
            if (radius > kLargestRadius) break;
            continue;
        }
        const double promised = -(vector(cost.gradient).dot(step->p) + 0.5 * step->p.dot(H * step->p));
        if (promised < options.cost_tolerance) {
            result.converged = true;
            break;
        }
        if (longest(step->p) < radius && result.log_cost - kMostOfPromise * promised > options.wanted) break;
        // Back to the curved constraints before the cost is asked: a sweep costs a tenth of a simulation.
        auto candidate = restored(sweep, moved(result.x, step->p));
        std::optional<PricedDesign> priced;
        if (candidate && longest(difference(candidate->x, result.x)) < kFarRestored * radius &&
            stays_stable(candidate->x)) {
            stable = candidate->x;
            priced.emplace(problem, candidate->x, options.simulation_tolerance);
        }
        const double won = cost.value - (priced ? priced->log_cost() : INFINITY);
        if (!(won > kEnoughWon * promised)) {
            radius = std::min(radius, longest(step->p)) * 0.3;
            if (radius < kSmallestRadius) break;
            continue;
        }
        if (won > kMuchWon * promised) radius = std::min(2 * radius, 1.0);
        small_steps = won < options.cost_tolerance ? small_steps + 1 : 0;
        const DesignPoint before = std::exchange(result.x, candidate->x);
        result.stable = true;
        result.log_cost = priced->log_cost();
        result.converged = small_steps >= kSmallStepsToEnd;
        if ((report && !report(result.x, result.log_cost)) || result.converged) break;
        const CostWithGradient next = priced->with_gradient();
        Vector3 y = difference(next.gradient, cost.gradient);
        for (std::size_t i = 0; i < std::min(peaks.size(), kPeaks); ++i) {
            const double lambda = step->multipliers[i];
            if (lambda == 0) continue;
            y += lambda * difference(followed(candidate->peaks, peaks[i]), peaks[i].gradient);
        }
        const Vector3 moved_by = difference(result.x, before);
        update(H, moved_by, y, n);
        // From a tiny step gradients' rounding tells more than their change.
        if (longest(moved_by) > kTellingStep) result.curvature = curvature(H);
        cost = next;
        peaks = std::move(candidate->peaks);
    }
    return result;
}

}  // namespace tunewright::robust
