#include "engine/range/search/joint_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/range/search/minimax_program.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::range {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using robust::ActivePeak;
using robust::DesignPoint;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPenalty = 40;           // of ln of the price for one of ln of a limit: above most multipliers
constexpr double kMostPenalty = 4e4;      // next to the least limits that any design keeps they grow without bound
constexpr double kHarder = 10;            // times the penalty, where the limits were not held
constexpr double kNear = -0.25;           // limits below it cannot become active within a step
constexpr double kNearPrice = 0.5;        // prices so far below the largest cannot become it within a step
constexpr double kAimBelow = 1e-6;        // feasibility is aimed this far inside
constexpr std::size_t kPeaks = 6;         // of a place, the largest ones, as constraints of a step
constexpr double kFirstCurvature = 0.3;   // of ln of the price over logarithms
constexpr double kSlackCurvature = 1e-6;  // of the two unknowns that enter linearly
constexpr double kSlackSize = 60;         // bound of theirs: beyond any logarithm
constexpr int kMostCorrections = 3;       // Newton steps back to the curved limits
constexpr double kFarCorrected = 3;       // radii: what a correction moved further is another design
constexpr double kPowellDamping = 0.2;    // of p.H p, which p.y keeps at least (Powell 1978)
constexpr double kSamePeak = 0.3;         // ln omega: a peak that moves further is another one
constexpr double kEnoughWon = 0.05, kMuchWon = 0.7;  // of what the model promised: to be taken, for a longer step
constexpr double kLeastRadius = 1e-4;                // of `step`
constexpr double kMostRadius = 4;

/// The unknowns of a step: p, then t (the price) and s (the excess).
struct Layout {
    Index n = 0;
    Index price() const { return n; }
    Index excess() const { return n + 1; }
    Index size() const { return n + 2; }
};

struct PlaceState {
    DesignPoint x{};
    double price = kInfinity;
    std::optional<robust::PricedDesign> priced;  // the runs behind the price
    std::vector<ActivePeak> peaks;
    SettingsSlope slope;
    Eigen::Vector3d price_gradient = Eigen::Vector3d::Zero();
    bool has_gradient = false;
};

struct State {
    VectorXd v;
    std::vector<PlaceState> places;
    double price = kInfinity, excess = kInfinity;
};

Eigen::Vector3d as_vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

class JointSearch {
public:
    JointSearch(const JointProblem& problem, const JointOptions& options, double penalty)
        : problem_(problem), options_(options), penalty_(penalty) {
        layout_.n = problem.low.size();
        H_ = MatrixXd::Zero(layout_.n, layout_.n);
        for (Index i = 0; i < layout_.n; ++i) H_(i, i) = kFirstCurvature * std::pow(0.5 / problem.step[i], 2);
    }

    JointResult run(const VectorXd& start, const std::function<void(const JointResult&)>& report) {
        State now = with_limits(start);
        ask_price(now);
        JointResult result;
        if (!std::isfinite(merit(now))) return answer(now, result);
        add_gradients(now);
        double radius = 1;
        for (; result.iterations < options_.most_iterations && !done(now); ++result.iterations) {
            if (options_.stop.stop_requested()) {
                result.stopped = true;
                break;
            }
            const auto program = step_program(now, radius);
            const auto step = solve(program);
            if (!step) {
                radius *= 0.3;
                if (radius < kLeastRadius) break;
                continue;
            }
            const VectorXd p = step->z.head(layout_.n);
            const double promised = merit(now) - model_merit(now, *step, program.g);
            if (promised < options_.cost_tolerance) break;
            State next = corrected(now, p, radius);
            if (std::isfinite(next.excess) && penalty_ * next.excess < merit(now)) ask_price(next);
            const double won = merit(now) - merit(next);
            if (!(won > kEnoughWon * promised)) {
                radius = 0.3 * std::min(radius, (p.cwiseQuotient(problem_.step)).cwiseAbs().maxCoeff());
                if (radius < kLeastRadius) break;
                continue;
            }
            if (won > kMuchWon * promised) radius = std::min(2 * radius, kMostRadius);
            add_gradients(next);
            learn_curvature(now, next, *step);
            const bool slow = next.excess <= 0 && won < options_.hopeless * (next.price - options_.enough);
            now = std::move(next);
            if (report) report(answer(now, result));
            slow_steps_ = slow ? slow_steps_ + 1 : 0;
            if (slow_steps_ == 2) break;
        }
        return answer(now, result);
    }

private:
    static JointResult answer(const State& state, JointResult result) {
        result.v = state.v;
        result.log_price = state.price;
        result.excess = state.excess;
        return result;
    }

    double merit(const State& state) const { return state.price + penalty_ * std::max(0.0, state.excess); }

    bool done(const State& now) const { return now.price <= options_.enough && now.excess <= 0; }

    /// Settings and peaks at every place; the price is not known yet.
    State with_limits(const VectorXd& v) const {
        State state{.v = v, .places = {}, .price = kInfinity, .excess = -kInfinity};
        for (const Place* place : problem_.places) {
            PlaceState one;
            one.slope.resize(3, layout_.n);
            one.x = problem_.settings(v, place->at(), &one.slope);
            one.peaks = place->sweep().peaks(one.x, kNear);
            if (!one.peaks.empty()) state.excess = std::max(state.excess, one.peaks.front().value + options_.margin);
            state.places.push_back(std::move(one));
        }
        state.excess = std::max(state.excess, kNear);
        return state;
    }

    /// Infinite where a loop is unstable.
    void ask_price(State& state) const {
        state.price = kInfinity;
        for (std::size_t k = 0; k < state.places.size(); ++k)
            if (!robust::is_stable(problem_.places[k]->problem(), state.places[k].x)) return;
        double worst = -kInfinity, sum = 0;
        for (std::size_t k = 0; k < state.places.size(); ++k) {
            PlaceState& one = state.places[k];
            one.priced = problem_.places[k]->priced(one.x, options_.simulation_tolerance);
            one.price = problem_.places[k]->log_price(*one.priced);
            worst = std::max(worst, one.price);
            sum += std::exp(one.price);
        }
        state.price = problem_.aim == Aim::worst ? worst : std::log(sum / double(state.places.size()));
    }

    void add_gradients(State& state) const {
        for (PlaceState& one : state.places) {
            if (problem_.aim == Aim::worst && one.price < state.price - kNearPrice) continue;
            one.price_gradient = as_vector(one.priced->with_gradient().gradient);
            one.has_gradient = one.price_gradient.allFinite();
        }
    }

    VectorXd gradient_of(const PlaceState& one, const Eigen::Vector3d& local) const {
        return one.slope.transpose() * local;
    }

    /// Of the mean: each place's share of the sum.
    double share(const State& state, const PlaceState& one) const {
        return std::exp(one.price - state.price) / double(state.places.size());
    }

    QuadraticProgram step_program(const State& now, double radius) const {
        std::vector<VectorXd> rows;
        std::vector<double> bounds;
        VectorXd g = VectorXd::Zero(layout_.size());
        const auto add = [&](const VectorXd& by_p, double by_price, double by_excess, double bound) {
            VectorXd row(layout_.size());
            row << by_p, by_price, by_excess;
            rows.push_back(std::move(row));
            bounds.push_back(bound);
        };
        const VectorXd none = VectorXd::Zero(layout_.n);
        for (const PlaceState& one : now.places) {
            if (one.has_gradient && problem_.aim == Aim::worst)
                add(gradient_of(one, one.price_gradient), -1, 0, now.price - one.price);
            if (one.has_gradient && problem_.aim == Aim::mean)
                g.head(layout_.n) += share(now, one) * gradient_of(one, one.price_gradient);
            for (std::size_t i = 0; i < std::min(one.peaks.size(), kPeaks); ++i)
                add(gradient_of(one, as_vector(one.peaks[i].gradient)), 0, -1,
                    -one.peaks[i].value - options_.margin - kAimBelow);
        }
        add(none, 0, -1, 0);
        add(none, 0, 1, kSlackSize);
        add(none, -1, 0, kSlackSize);
        add_box(now.v, radius, add);
        g[layout_.price()] = problem_.aim == Aim::worst ? 1 : 0;
        g[layout_.excess()] = penalty_;
        QuadraticProgram program{.H = MatrixXd::Zero(layout_.size(), layout_.size()), .g = g, .A = {}, .b = {}};
        program.H.topLeftCorner(layout_.n, layout_.n) = H_;
        program.H(layout_.price(), layout_.price()) = program.H(layout_.excess(), layout_.excess()) = kSlackCurvature;
        fill(program, rows, bounds);
        return program;
    }

    template <class Add>
    void add_box(const VectorXd& v, double radius, const Add& add) const {
        for (Index i = 0; i < layout_.n; ++i) {
            const VectorXd unit = VectorXd::Unit(layout_.n, i);
            const double reach = radius * problem_.step[i];
            add(unit, 0, 0, std::clamp(problem_.high[i] - v[i], 0.0, reach));
            add(-unit, 0, 0, std::clamp(v[i] - problem_.low[i], 0.0, reach));
        }
    }

    static void fill(QuadraticProgram& program, const std::vector<VectorXd>& rows, const std::vector<double>& bounds) {
        program.A.resize(Index(rows.size()), program.g.size());
        program.b.resize(Index(rows.size()));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            program.A.row(Index(i)) = rows[i].transpose();
            program.b[Index(i)] = bounds[i];
        }
    }

    /// What the model says the merit will be.
    double model_merit(const State& now, const ProgramSolution& step, const VectorXd& g) const {
        const VectorXd p = step.z.head(layout_.n);
        const double linear = problem_.aim == Aim::worst ? step.z[layout_.price()] : double(g.head(layout_.n).dot(p));
        return now.price + linear + 0.5 * p.dot(H_ * p) + penalty_ * std::max(0.0, step.z[layout_.excess()]);
    }

    /// The step, and after it back to the curved limits along the shortest way.
    State corrected(const State& now, const VectorXd& p, double radius) const {
        State next = with_limits(kept_in(now.v + p));
        for (int k = 0; k < kMostCorrections && next.excess > 0; ++k) {
            const auto way = solve(correction_program(next, radius));
            if (!way) break;
            State other = with_limits(kept_in(next.v + way->z.head(layout_.n)));
            const double moved = (other.v - now.v).cwiseQuotient(problem_.step).cwiseAbs().maxCoeff();
            if (!(other.excess < next.excess) || moved > kFarCorrected * radius) break;
            next = std::move(other);
        }
        return next;
    }

    VectorXd kept_in(const VectorXd& v) const { return v.cwiseMax(problem_.low).cwiseMin(problem_.high); }

    QuadraticProgram correction_program(const State& state, double radius) const {
        std::vector<VectorXd> rows;
        std::vector<double> bounds;
        const Index size = layout_.n + 1;
        const auto add = [&](const VectorXd& by_p, double, double by_excess, double bound) {
            VectorXd row(size);
            row << by_p, by_excess;
            rows.push_back(std::move(row));
            bounds.push_back(bound);
        };
        for (const PlaceState& one : state.places)
            for (std::size_t i = 0; i < std::min(one.peaks.size(), kPeaks); ++i)
                add(gradient_of(one, as_vector(one.peaks[i].gradient)), 0, -1,
                    -one.peaks[i].value - options_.margin - kAimBelow);
        add(VectorXd::Zero(layout_.n), 0, -1, 0);
        add_box(state.v, radius, add);
        QuadraticProgram program{.H = MatrixXd::Zero(size, size), .g = VectorXd::Zero(size), .A = {}, .b = {}};
        for (Index i = 0; i < layout_.n; ++i) program.H(i, i) = std::pow(0.5 / problem_.step[i], 2);
        program.H(layout_.n, layout_.n) = kSlackCurvature;
        program.g[layout_.n] = penalty_;
        fill(program, rows, bounds);
        return program;
    }

    /// BFGS on the Lagrangian with Powell's damping. Multipliers follow the order of step_program's rows.
    void learn_curvature(const State& now, const State& next, const ProgramSolution& step) {
        const VectorXd p = next.v - now.v;
        VectorXd y = VectorXd::Zero(layout_.n);
        Index row = 0;
        for (std::size_t k = 0; k < now.places.size(); ++k) {
            const PlaceState &old = now.places[k], &fresh = next.places[k];
            if (old.has_gradient) {
                const double weight = problem_.aim == Aim::worst ? step.multipliers[row++] : share(now, old);
                if (fresh.has_gradient)
                    y += weight * (gradient_of(fresh, fresh.price_gradient) - gradient_of(old, old.price_gradient));
            }
            for (std::size_t i = 0; i < std::min(old.peaks.size(), kPeaks); ++i, ++row) {
                const double weight = step.multipliers[row];
                if (weight < 1e-8) continue;
                const ActivePeak* same = followed(fresh.peaks, old.peaks[i]);
                if (same == nullptr) continue;
                y += weight * (gradient_of(fresh, as_vector(same->gradient)) -
                               gradient_of(old, as_vector(old.peaks[i].gradient)));
            }
        }
        const VectorXd Hp = H_ * p;
        const double pHp = p.dot(Hp), py = p.dot(y);
        if (!(pHp > 1e-300)) return;
        if (py < kPowellDamping * pHp) {
            const double theta = (1 - kPowellDamping) * pHp / (pHp - py);
            y = theta * y + (1 - theta) * Hp;
        }
        H_ += y * y.transpose() / p.dot(y) - Hp * Hp.transpose() / pHp;
    }

    static const ActivePeak* followed(const std::vector<ActivePeak>& peaks, const ActivePeak& old) {
        const ActivePeak* best = nullptr;
        const auto distance = [&](const ActivePeak& peak) {
            return peak.omega == old.omega ? 0 : std::abs(std::log(peak.omega / old.omega));
        };
        for (const ActivePeak& peak : peaks)
            if (peak.kind == old.kind && peak.plant == old.plant &&
                (best == nullptr || distance(peak) < distance(*best)))
                best = &peak;
        return best != nullptr && distance(*best) < kSamePeak ? best : nullptr;
    }

    const JointProblem& problem_;
    const JointOptions& options_;
    double penalty_;
    Layout layout_;
    MatrixXd H_;
    int slow_steps_ = 0;
};

}  // namespace

JointResult search_jointly(const JointProblem& problem, const VectorXd& start, const JointOptions& options,
                           const std::function<void(const JointResult&)>& report) {
    JointResult end = JointSearch(problem, options, kPenalty).run(start, report);
    const auto failed = [&] { return !end.holds() && !end.stopped && std::isfinite(end.log_price); };
    for (double penalty = kHarder * kPenalty; failed() && penalty <= kMostPenalty; penalty *= kHarder)
        end = JointSearch(problem, options, penalty).run(end.v, report);
    return end;
}

}  // namespace tunewright::range
