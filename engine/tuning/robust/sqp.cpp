#include "engine/tuning/robust/sqp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/numerics/optimise/sqp.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/feasibility.h"

namespace tunewright::robust {
namespace {

using optimise::SmallProgram;
using Vector = SmallProgram::Vector;
using Matrix = SmallProgram::Matrix;

/// Constants of the problem, in units of logarithms unless stated otherwise; those of the iteration are
/// `optimise::SqpConstants`. They were chosen during development on the AMIGO batch and random plants;
/// `bench/robust_batch` measures the effect of a change on the time, `bench/robust_search` on the designs.
struct DesignSqpConstants {
    double near = -0.25;                                  ///< lower constraints cannot become active within a step
    double aim_below = 1e-7;                              ///< feasibility is aimed this far inside
    double feasible = limits::kMaxRelativeExcessStepped;  ///< and accepted with this much slack
    std::size_t max_peaks = 8;                            ///< largest peaks that are constraints of a step
    int max_restoring_steps = 12;         ///< Newton steps back to the feasible side; three or four are usual
    double near_of_restoring = -0.1;      ///< lower constraints do not limit a step back
    double restoring_radius = 0.5;        ///< the first trust region of a step back
    std::size_t max_restoring_peaks = 6;  ///< largest peaks that are constraints of a step back
    double gain_per_excess = 1.5;         ///< reduction of the gain if the peaks' linear models have no common solution
    double min_less_gain = 1e-6;          ///< of ln Kp
    double max_less_gain = 0.3;           ///< of ln Kp
    double max_restored_radii = 4;        ///< a restoration that moves further gives another design
    int small_steps_to_end = 2;           ///< successive steps, each within the tolerance of the cost
    double max_gain_over_predicted = 5;   ///< a run rarely gains more than this multiple of the decrease that the model
                                          ///< predicts
    double min_curvature_step = 1e-3;     ///< the curvature after shorter steps is not passed on
    double same_peak = 0.3;               ///< in ln omega: a peak that moves further counts as another one
    double min_radius = 1e-5, max_radius = 1;
    double hopeless_radius = 4;  ///< beyond it the linear models have no common solution
};
constexpr DesignSqpConstants k;
static_assert(k.max_peaks + 6 <= 14, "SmallProgram must have room for the peaks and the bounds of three unknowns");

double longest(const Vector& v) { return v.cwiseAbs().maxCoeff(); }
Vector vector(const std::array<double, 3>& a, int n) { return Eigen::Map<const Vector>(a.data(), n); }
Vector difference(const std::array<double, 3>& a, const std::array<double, 3>& b, int n) {
    return vector(a, n) - vector(b, n);
}
DesignPoint moved(DesignPoint x, const Vector& p) {
    for (Eigen::Index i = 0; i < p.size(); ++i) x[std::size_t(i)] += p[i];
    return x;
}

/// The linear models of the `max` largest peaks, and the trust region, which ends at the bounds of Ti and Td, for a
/// step from x. H and g are those of the problem of the shortest step.
SmallProgram linearised(const std::vector<ActivePeak>& peaks, const Sweep& sweep, const DesignPoint& x, double radius,
                        std::size_t max) {
    const int n = sweep.problem().dimension();
    const std::size_t count = std::min(max, peaks.size());
    SmallProgram program(n, Eigen::Index(count) + 2 * n);
    for (std::size_t i = 0; i < count; ++i) program.add(vector(peaks[i].gradient, n), -peaks[i].value - k.aim_below);
    const auto log_time = [&](double in_reference) { return std::log(in_reference / sweep.reference()); };
    const std::array<double, 3> lowest = {-INFINITY, log_time(kMinTi), log_time(kMinTd)};
    const std::array<double, 3> highest = {INFINITY, INFINITY, log_time(kMaxTd)};
    for (int i = 0; i < n; ++i) {
        const Vector up = Vector::Unit(n, i);
        const auto at = std::size_t(i);
        program.add(up, std::clamp(highest[at] - x[at], 0.0, radius));
        program.add(-up, std::clamp(x[at] - lowest[at], 0.0, radius));
    }
    return program;
}

}  // namespace

const ActivePeak* same_peak(const std::vector<ActivePeak>& peaks, const ActivePeak& old) {
    const ActivePeak* best = nullptr;
    const auto distance = [&](const ActivePeak& peak) {
        return peak.omega == old.omega ? 0 : std::abs(std::log(peak.omega / old.omega));
    };
    for (const ActivePeak& peak : peaks)
        if (peak.kind == old.kind && peak.plant == old.plant && (best == nullptr || distance(peak) < distance(*best)))
            best = &peak;
    return best != nullptr && distance(*best) < k.same_peak ? best : nullptr;
}

bool is_stable(const DesignProblem& problem, const DesignPoint& x) {
    return holds_on_every_loop(problem, to_parallel(controller_at(problem, x)),
                               [](const auto& loop) { return tunewright::is_stable(loop); });
}

namespace {

/// A design within the limits, and its peaks above `near`.
struct Restored {
    DesignPoint x;
    std::vector<ActivePeak> peaks;
};

std::optional<Restored> restored(const Sweep& sweep, DesignPoint x) {
    for (int i = 0; i < k.max_restoring_steps; ++i) {
        auto peaks = sweep.peaks(x, k.near);
        if (peaks.empty() || peaks[0].value <= -k.feasible / 10) return Restored{x, std::move(peaks)};
        const auto in_the_way =
            std::ranges::count_if(peaks, [](const ActivePeak& peak) { return peak.value > k.near_of_restoring; });
        const auto step = solve(
            linearised(peaks, sweep, x, k.restoring_radius, std::min(k.max_restoring_peaks, std::size_t(in_the_way))));
        if (step)
            x = moved(x, step->x);
        else
            x[0] -= std::clamp(k.gain_per_excess * peaks[0].value, k.min_less_gain, k.max_less_gain);
    }
    auto peaks = sweep.peaks(x, k.near);
    if (peaks.empty() || peaks[0].value <= k.feasible) return Restored{x, std::move(peaks)};
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

namespace {

/// Implements the problem of `optimise::minimise`: every state is within the limits, so its merit is the cost itself.
class DesignSqp {
public:
    struct State {
        DesignPoint x{};
        std::vector<ActivePeak> peaks;
        std::optional<EvaluatedDesign> evaluated;
        CostWithGradient cost;
    };
    struct Step {
        Vector p;
        double predicted = 0;  // of ln(cost)
        SmallProgram::Bounds multipliers;
    };
    static constexpr bool kElastic = false;

    DesignSqp(const Sweep& sweep, const DesignProblem& problem, const DesignPoint& start, const SqpOptions& options,
              const Report& report)
        : sweep_(sweep), problem_(problem), options_(options), report_(report), n_(problem.dimension()) {
        if (options.stable_start) last_stable_ = start;
        H_ = optimise::kSqp.first_curvature * Matrix::Identity(n_, n_);
        for (int i = 0; options.curvature && i < n_; ++i)
            H_.row(i) = vector((*options.curvature)[std::size_t(i)], n_).transpose();
    }

    SqpResult run(const DesignPoint& start) {
        auto inside = restored(sweep_, start);
        State here{.x = inside ? inside->x : start, .peaks = {}, .evaluated = {}, .cost = {}};
        here.evaluated.emplace(problem_, here.x, options_.simulation_tolerance);
        differentiate(here);
        result_.x = here.x;
        result_.log_cost = here.cost.value;
        if (!std::isfinite(here.cost.value)) return result_;
        here.peaks = inside ? std::move(inside->peaks) : sweep_.peaks(here.x, k.near);
        const auto end = optimise::minimise(*this, here,
                                            {.radius = options_.trust_radius,
                                             .min_radius = k.min_radius,
                                             .max_radius = k.max_radius,
                                             .hopeless_radius = k.hopeless_radius},
                                            options_.max_iterations, options_.cost_tolerance);
        result_.iterations = end.iterations;
        result_.converged |= end.converged;
        return result_;
    }

    std::optional<Step> step(const State& here, double radius) const {
        SmallProgram program = linearised(here.peaks, sweep_, here.x, radius, k.max_peaks);
        program.H = H_;
        program.g = vector(here.cost.gradient, n_);
        const auto minimum = solve(program);
        if (!minimum) return std::nullopt;
        const Vector& p = minimum->x;
        return Step{p, -(program.g.dot(p) + 0.5 * p.dot(H_ * p)), minimum->multipliers};
    }

    double length(const Step& step) const { return longest(step.p); }

    bool worth_trying(const State& here, const Step& step, double radius) const {
        return !(longest(step.p) < radius &&
                 here.cost.value - k.max_gain_over_predicted * step.predicted > options_.wanted);
    }

    /// Restores feasibility before the cost is computed: a sweep costs a tenth of a simulation.
    std::optional<State> candidate(const State& here, const Step& step, double radius) {
        auto inside = restored(sweep_, moved(here.x, step.p));
        if (!inside || !(longest(difference(inside->x, here.x, n_)) < k.max_restored_radii * radius) ||
            !stays_stable(inside->x))
            return std::nullopt;
        last_stable_ = inside->x;
        State next{.x = inside->x, .peaks = std::move(inside->peaks), .evaluated = {}, .cost = {}};
        next.evaluated.emplace(problem_, next.x, options_.simulation_tolerance);
        next.cost.value = next.evaluated->log_cost();
        return next;
    }

    double merit(const State& state) const { return state.cost.value; }

    bool accepted(const State& here, double won) {
        small_steps_ = won < options_.cost_tolerance ? small_steps_ + 1 : 0;
        result_.x = here.x;
        result_.stable = true;
        result_.log_cost = here.cost.value;
        result_.converged = small_steps_ >= k.small_steps_to_end;
        return (!report_ || report_(here.x, here.cost.value)) && !result_.converged;
    }

    void differentiate(State& state) const { state.cost = state.evaluated->with_gradient(); }

    void learn(const State& before, const State& here, const Step& step) {
        Vector y = difference(here.cost.gradient, before.cost.gradient, n_);
        for (std::size_t i = 0; i < std::min(before.peaks.size(), k.max_peaks); ++i) {
            const double multiplier = step.multipliers[Eigen::Index(i)];
            const ActivePeak* same = multiplier > 0 ? same_peak(here.peaks, before.peaks[i]) : nullptr;
            if (same != nullptr) y += multiplier * difference(same->gradient, before.peaks[i].gradient, n_);
        }
        const Vector moved_by = difference(here.x, before.x, n_);
        optimise::update_curvature(H_, moved_by, y);
        // After a tiny step, the change of the gradients is mainly rounding.
        if (!(longest(moved_by) > k.min_curvature_step)) return;
        // A parameter that this search does not vary gets the first curvature: a later search needs a positive one.
        Curvature& seen = result_.curvature.emplace();
        for (std::size_t i = 0; i < seen.size(); ++i) seen[i][i] = optimise::kSqp.first_curvature;
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) seen[std::size_t(i)][std::size_t(j)] = H_(i, j);
    }

private:
    bool stays_stable(const DesignPoint& x) const {
        return (last_stable_ && sweep_.stays_stable(*last_stable_, x)) || is_stable(problem_, x);
    }

    const Sweep& sweep_;
    const DesignProblem& problem_;
    const SqpOptions& options_;
    const Report& report_;
    int n_;
    Matrix H_;  // Hessian of ln(cost) and the active limits
    std::optional<DesignPoint> last_stable_;
    int small_steps_ = 0;
    SqpResult result_;
};

}  // namespace

SqpResult minimise(const Sweep& sweep, const DesignProblem& problem, const DesignPoint& start,
                   const SqpOptions& options, const Report& report) {
    return DesignSqp(sweep, problem, start, options, report).run(start);
}

}  // namespace tunewright::robust
