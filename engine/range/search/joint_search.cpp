#include "engine/range/search/joint_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/numerics/optimise/sqp.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::range {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using optimise::LargeProgram;
using robust::ActivePeak;
using robust::DesignPoint;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Constants of the problem; those of the iteration are `optimise::SqpConstants`. They were chosen during development
/// on ranges of first-order plants, the conical tank and the reactor; tests/engine/range checks the results.
struct JointSqpConstants {
    double penalty = 40;             ///< d ln(cost)/d ln(limit): larger than most multipliers
    double max_penalty = 4e4;        ///< near the tightest limits of any design the multipliers are unbounded
    double harder = 10;              ///< factor of the penalty if the limits were not kept
    double near = -0.25;             ///< ln of a limit's ratio: smaller ones cannot become active within a step
    double near_worst = 0.5;         ///< in ln of the cost: smaller ones cannot become the largest within a step
    double aim_below = 1e-6;         ///< feasibility is aimed at by this margin
    std::size_t max_peaks = 6;       ///< of each point, the largest ones, as constraints of a step
    double slack_curvature = 1e-6;   ///< of the two unknowns that enter linearly, because H must be positive definite
    double slack_size = 60;          ///< bound of these two: larger than any logarithm
    int max_corrections = 3;         ///< Newton steps back to the curved limits
    double max_corrected_radii = 3;  ///< a correction that moves further gives another design
    double min_radius = 1e-4, max_radius = 4;  ///< of `step`
    int slow_steps_to_end = 2;                 ///< successive slow steps that end the search
};
constexpr JointSqpConstants k_;

/// The unknowns of a step: p, then t (the cost) and s (the excess).
struct Layout {
    Index n = 0;
    Index cost() const { return n; }
    Index excess() const { return n + 1; }
    Index size() const { return n + 2; }
};

struct PointState {
    DesignPoint x{};
    double cost = kInfinity;
    std::optional<robust::EvaluatedDesign> evaluated;  // the simulations of the cost
    std::vector<ActivePeak> peaks;
    SettingsSlope slope;
    Eigen::Vector3d cost_gradient = Eigen::Vector3d::Zero();
    bool has_gradient = false;
};

struct State {
    VectorXd v;
    std::vector<PointState> places;
    double cost = kInfinity, excess = kInfinity;
};

Eigen::Vector3d as_vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Implements the problem of `optimise::minimise`.
class JointSqp {
public:
    using State = tunewright::range::State;
    struct Step {
        VectorXd p;
        double predicted = 0;  // predicted decrease of the merit function
        VectorXd multipliers;
    };
    static constexpr bool kElastic = true;

    JointSqp(const JointProblem& problem, const JointOptions& options, double penalty,
             const std::function<void(const JointResult&)>& report)
        : problem_(problem), options_(options), penalty_(penalty), report_(report) {
        layout_.n = problem.low.size();
        H_ = MatrixXd::Zero(layout_.n, layout_.n);
        for (Index i = 0; i < layout_.n; ++i)
            H_(i, i) = optimise::kSqp.first_curvature * std::pow(0.5 / problem.step[i], 2);
    }

    JointResult run(const VectorXd& start) {
        State now = with_limits(start);
        ask_cost(now);
        if (!std::isfinite(merit(now)) || done(now)) return answer(now);
        differentiate(now);
        optimise::minimise(*this, now, {.radius = 1, .min_radius = k_.min_radius, .max_radius = k_.max_radius},
                           options_.max_iterations, options_.cost_tolerance);
        return answer(now);
    }

    std::optional<Step> step(const State& now, double radius) const {
        const auto program = step_program(now, radius);
        const auto minimum = solve(program);
        if (!minimum) return std::nullopt;
        return Step{minimum->x.head(layout_.n), merit(now) - model_merit(now, minimum->x, program.g),
                    minimum->multipliers};
    }

    double length(const Step& step) const { return step.p.cwiseQuotient(problem_.step).cwiseAbs().maxCoeff(); }

    bool worth_trying(const State&, const Step&, double) {
        result_.stopped = options_.stop.stop_requested();
        return !result_.stopped;
    }

    std::optional<State> candidate(const State& now, const Step& step, double radius) const {
        State next = corrected(now, step.p, radius);
        if (std::isfinite(next.excess) && penalty_ * next.excess < merit(now)) ask_cost(next);
        return next;
    }

    bool accepted(const State& now, double won) {
        if (report_) report_(answer(now));
        const bool slow = now.excess <= 0 && won < options_.hopeless * (now.cost - options_.enough);
        slow_steps_ = slow ? slow_steps_ + 1 : 0;
        return slow_steps_ < k_.slow_steps_to_end && !done(now);
    }

    double merit(const State& state) const { return state.cost + penalty_ * std::max(0.0, state.excess); }

    void differentiate(State& state) const {
        for (PointState& one : state.places) {
            if (problem_.aim == Aim::worst && one.cost < state.cost - k_.near_worst) continue;
            one.cost_gradient = as_vector(one.evaluated->with_gradient().gradient);
            one.has_gradient = one.cost_gradient.allFinite();
        }
    }

    void learn(const State& now, const State& next, const Step& step) {
        const VectorXd p = next.v - now.v;
        VectorXd y = VectorXd::Zero(layout_.n);
        // The rows of `step_program`: costs, the excess >= 0, limits.
        Index cost = 0, limit = 1;
        if (problem_.aim == Aim::worst) limit += std::ranges::count(now.places, true, &PointState::has_gradient);
        for (std::size_t k = 0; k < now.places.size(); ++k) {
            const PointState &old = now.places[k], &fresh = next.places[k];
            if (old.has_gradient) {
                const double weight = problem_.aim == Aim::worst ? step.multipliers[cost++] : share(now, old);
                if (fresh.has_gradient)
                    y += weight * (gradient_of(fresh, fresh.cost_gradient) - gradient_of(old, old.cost_gradient));
            }
            for (std::size_t i = 0; i < std::min(old.peaks.size(), k_.max_peaks); ++i) {
                const double weight = step.multipliers[limit++];
                const ActivePeak* same = weight > 0 ? robust::same_peak(fresh.peaks, old.peaks[i]) : nullptr;
                if (same == nullptr) continue;
                y += weight * (gradient_of(fresh, as_vector(same->gradient)) -
                               gradient_of(old, as_vector(old.peaks[i].gradient)));
            }
        }
        optimise::update_curvature(H_, p, y);
    }

private:
    bool done(const State& now) const { return now.cost <= options_.enough && now.excess <= 0; }

    /// Settings and peaks at every point; the cost is not computed yet.
    State with_limits(const VectorXd& v) const {
        State state{.v = v, .places = {}, .cost = kInfinity, .excess = -kInfinity};
        for (const PointDesign* place : problem_.places) {
            PointState one;
            one.slope.resize(3, layout_.n);
            one.x = problem_.settings(v, place->at(), &one.slope);
            one.peaks = place->sweep().peaks(one.x, k_.near);
            if (!one.peaks.empty()) state.excess = std::max(state.excess, one.peaks.front().value + options_.margin);
            state.places.push_back(std::move(one));
        }
        state.excess = std::max(state.excess, k_.near);
        return state;
    }

    JointResult answer(const State& state) const {
        JointResult result = result_;
        result.v = state.v;
        result.log_cost_ratio = state.cost;
        result.excess = state.excess;
        return result;
    }

    /// Computes the cost; infinite if a loop is unstable.
    void ask_cost(State& state) const {
        state.cost = kInfinity;
        for (std::size_t k = 0; k < state.places.size(); ++k)
            if (!robust::is_stable(problem_.places[k]->problem(), state.places[k].x)) return;
        double worst = -kInfinity, sum = 0;
        for (std::size_t k = 0; k < state.places.size(); ++k) {
            PointState& one = state.places[k];
            one.evaluated = problem_.places[k]->evaluated(one.x, options_.simulation_tolerance);
            one.cost = problem_.places[k]->log_cost_ratio(*one.evaluated);
            worst = std::max(worst, one.cost);
            sum += std::exp(one.cost);
        }
        state.cost = problem_.aim == Aim::worst ? worst : std::log(sum / double(state.places.size()));
    }

    VectorXd gradient_of(const PointState& one, const Eigen::Vector3d& local) const {
        return one.slope.transpose() * local;
    }

    /// For the mean: each point's share of the sum.
    double share(const State& state, const PointState& one) const {
        return std::exp(one.cost - state.cost) / double(state.places.size());
    }

    /// Adds the limits' linear models at every point, with `excess` as the last unknown.
    void add_limits(const State& state, LargeProgram& program) const {
        VectorXd normal = VectorXd::Zero(program.g.size());
        normal[normal.size() - 1] = -1;
        program.add(normal, 0);
        for (const PointState& one : state.places)
            for (std::size_t i = 0; i < std::min(one.peaks.size(), k_.max_peaks); ++i) {
                normal.head(layout_.n) = gradient_of(one, as_vector(one.peaks[i].gradient));
                program.add(normal, -one.peaks[i].value - options_.margin - k_.aim_below);
            }
    }

    void add_box(const VectorXd& v, double radius, LargeProgram& program) const {
        for (Index i = 0; i < layout_.n; ++i) {
            const auto unit = VectorXd::Unit(program.g.size(), i);
            const double reach = radius * problem_.step[i];
            program.add(unit, std::clamp(problem_.high[i] - v[i], 0.0, reach));
            program.add(-unit, std::clamp(v[i] - problem_.low[i], 0.0, reach));
        }
    }

    LargeProgram empty_program(Index unknowns) const {
        const Index places = Index(problem_.places.size());
        LargeProgram program(unknowns, places * (1 + Index(k_.max_peaks)) + 3 + 2 * layout_.n);
        program.H.setZero();
        return program;
    }

    /// The costs of the points come first, because `learn` reads their multipliers there, then the limits.
    LargeProgram step_program(const State& now, double radius) const {
        LargeProgram program = empty_program(layout_.size());
        const auto unit = [&](Index i) { return VectorXd::Unit(layout_.size(), i); };
        VectorXd normal = -unit(layout_.cost());
        for (const PointState& one : now.places) {
            if (!one.has_gradient) continue;
            const VectorXd gradient = gradient_of(one, one.cost_gradient);
            if (problem_.aim == Aim::mean) program.g.head(layout_.n) += share(now, one) * gradient;
            if (problem_.aim == Aim::mean) continue;
            normal.head(layout_.n) = gradient;
            program.add(normal, now.cost - one.cost);
        }
        add_limits(now, program);
        program.add(unit(layout_.excess()), k_.slack_size);
        program.add(-unit(layout_.cost()), k_.slack_size);
        add_box(now.v, radius, program);
        program.g[layout_.cost()] = problem_.aim == Aim::worst ? 1 : 0;
        program.g[layout_.excess()] = penalty_;
        program.H.topLeftCorner(layout_.n, layout_.n) = H_;
        program.H(layout_.cost(), layout_.cost()) = program.H(layout_.excess(), layout_.excess()) = k_.slack_curvature;
        return program;
    }

    /// The merit that the model predicts.
    double model_merit(const State& now, const VectorXd& z, const VectorXd& g) const {
        const VectorXd p = z.head(layout_.n);
        const double linear = problem_.aim == Aim::worst ? z[layout_.cost()] : double(g.head(layout_.n).dot(p));
        return now.cost + linear + 0.5 * p.dot(H_ * p) + penalty_ * std::max(0.0, z[layout_.excess()]);
    }

    /// The step, corrected back to the curved limits along the shortest way.
    State corrected(const State& now, const VectorXd& p, double radius) const {
        State next = with_limits(kept_in(now.v + p));
        for (int k = 0; k < k_.max_corrections && next.excess > 0; ++k) {
            const auto way = solve(correction_program(next, radius));
            if (!way) break;
            State other = with_limits(kept_in(next.v + way->x.head(layout_.n)));
            const double moved = (other.v - now.v).cwiseQuotient(problem_.step).cwiseAbs().maxCoeff();
            if (!(other.excess < next.excess) || moved > k_.max_corrected_radii * radius) break;
            next = std::move(other);
        }
        return next;
    }

    VectorXd kept_in(const VectorXd& v) const { return v.cwiseMax(problem_.low).cwiseMin(problem_.high); }

    LargeProgram correction_program(const State& state, double radius) const {
        LargeProgram program = empty_program(layout_.n + 1);
        add_limits(state, program);
        add_box(state.v, radius, program);
        for (Index i = 0; i < layout_.n; ++i) program.H(i, i) = std::pow(0.5 / problem_.step[i], 2);
        program.H(layout_.n, layout_.n) = k_.slack_curvature;
        program.g[layout_.n] = penalty_;
        return program;
    }

    const JointProblem& problem_;
    const JointOptions& options_;
    double penalty_;
    const std::function<void(const JointResult&)>& report_;
    Layout layout_;
    MatrixXd H_;
    int slow_steps_ = 0;
    JointResult result_;
};

}  // namespace

JointResult search_jointly(const JointProblem& problem, const VectorXd& start, const JointOptions& options,
                           const std::function<void(const JointResult&)>& report) {
    JointResult end = JointSqp(problem, options, k_.penalty, report).run(start);
    const auto failed = [&] { return !end.holds() && !end.stopped && std::isfinite(end.log_cost_ratio); };
    for (double penalty = k_.harder * k_.penalty; failed() && penalty <= k_.max_penalty; penalty *= k_.harder)
        end = JointSqp(problem, options, penalty, report).run(end.v);
    return end;
}

}  // namespace tunewright::range
