#include "engine/structure/search/limited_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/numerics/optimise/sqp.h"

namespace tunewright::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using optimise::LargeProgram;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPenalty = 30;    // d ln(cost)/d ln(limit): larger than the multipliers of usual designs
constexpr double kNear = -0.3;     // ln of a peak over its limit: a lower one cannot become active within a step
constexpr double kFar = 0.5;       // beyond it the cost is not worth a simulation
constexpr double kAim = 2e-7;      // limits are aimed at by this margin
constexpr double kHeld = 1e-6;     // ln: holds the limit
constexpr int kCorrections = 4;    // steps back to the curved limits
constexpr double kOfPeak = 1e-5;   // difference of x, for the gradient of a peak
constexpr double kSlackSize = 60;  // bound of the elastic unknown

struct State {
    VectorXd x;
    double cost = kInfinity, excess = kInfinity;
    std::vector<LimitedPeak> peaks;
    VectorXd gradient;
    MatrixXd slopes;  // a column for each peak
};

class Search {
public:
    using State = structure::State;
    struct Step {
        VectorXd p;
        double predicted = 0;
        VectorXd multipliers;  // of the peaks
    };
    static constexpr bool kElastic = true;

    /// `margins`: ln by which each function must stay below its limit.
    Search(const LimitedProblem& problem, const LimitedOptions& options, const std::vector<double>& margins,
           const MatrixXd& curvature)
        : problem_(problem),
          options_(options),
          margins_(margins),
          n_(problem.low.size()),
          H_(curvature.size() > 0 ? curvature : MatrixXd(optimise::kSqp.first_curvature * MatrixXd::Identity(n_, n_))) {
    }

    LimitedResult run(const VectorXd& start) {
        State now = at(start);
        now.cost = checked_cost(now.x);
        if (std::isfinite(now.cost)) {
            differentiate(now);
            optimise::minimise(*this, now, {.radius = 0.3, .min_radius = 1e-5, .max_radius = 1},
                               options_.max_iterations, options_.cost_tolerance);
        }
        return {now.x, now.cost, now.excess, H_, options_.stop.stop_requested()};
    }

    /// The unknowns are p and the excess s that the linearised limits are allowed, at the price of the penalty.
    std::optional<Step> step(const State& now, double radius) const {
        const auto peaks = Index(now.peaks.size());
        LargeProgram program(n_ + 1, peaks + 2 * n_ + 2);
        program.H = MatrixXd::Identity(n_ + 1, n_ + 1) * 1e-6;
        program.H.topLeftCorner(n_, n_) = H_;
        program.g << now.gradient, kPenalty;
        for (Index i = 0; i < peaks; ++i) {
            VectorXd normal(n_ + 1);
            normal << now.slopes.col(i), -1;
            program.add(normal, -now.peaks[std::size_t(i)].excess - kAim);
        }
        program.add(-VectorXd::Unit(n_ + 1, n_), 0);
        program.add(VectorXd::Unit(n_ + 1, n_), kSlackSize);
        for (Index i = 0; i < n_; ++i) {
            program.add(VectorXd::Unit(n_ + 1, i), std::min(radius, problem_.high[i] - now.x[i]));
            program.add(-VectorXd::Unit(n_ + 1, i), std::min(radius, now.x[i] - problem_.low[i]));
        }
        const auto minimum = solve(program);
        if (!minimum) return std::nullopt;
        const VectorXd p = minimum->x.head(n_);
        const double model = now.gradient.dot(p) + 0.5 * p.dot(H_ * p) + kPenalty * std::max(0.0, minimum->x[n_]);
        return Step{p, kPenalty * std::max(0.0, now.excess) - model, minimum->multipliers.head(peaks)};
    }

    double length(const Step& step) const { return step.p.cwiseAbs().maxCoeff(); }
    bool worth_trying(const State&, const Step&, double) const { return !options_.stop.stop_requested(); }
    bool accepted(const State&, double) const { return true; }
    double merit(const State& state) const { return merit_of(state.cost, state.excess); }

    std::optional<State> candidate(const State& now, const Step& step, double radius) const {
        State next = corrected(now.x + step.p, 2 * radius);
        if (!(next.excess < kFar)) return std::nullopt;
        next.cost = checked_cost(next.x);
        return next;
    }

    void differentiate(State& state) const {
        state.gradient.resize(n_);
        for (Index i = 0; i < n_; ++i) {
            VectorXd up = state.x, down = state.x;
            up[i] = std::min(problem_.high[i], up[i] + options_.difference);
            down[i] = std::max(problem_.low[i], down[i] - options_.difference);
            const double above = problem_.log_cost(up), below = problem_.log_cost(down);
            if (std::isfinite(above) && std::isfinite(below))
                state.gradient[i] = (above - below) / (up[i] - down[i]);
            else
                state.gradient[i] = std::isfinite(below) ? (state.cost - below) / (state.x[i] - down[i])
                                                         : (above - state.cost) / (up[i] - state.x[i]);
            if (!std::isfinite(state.gradient[i])) state.gradient[i] = 0;
        }
    }

    void learn(const State& now, const State& next, const Step& step) {
        VectorXd y = next.gradient - now.gradient;
        for (std::size_t i = 0; i < now.peaks.size(); ++i) {
            const double weight = step.multipliers[Index(i)];
            if (!(weight > 0)) continue;
            const auto same = std::ranges::find_if(next.peaks, [&](const LimitedPeak& peak) {
                return peak.function == now.peaks[i].function &&
                       std::abs(std::log(peak.omega / now.peaks[i].omega)) < 0.3;
            });
            if (same != next.peaks.end())
                y += weight * (next.slopes.col(same - next.peaks.begin()) - now.slopes.col(Index(i)));
        }
        optimise::update_curvature(H_, VectorXd(next.x - now.x), y);
    }

private:
    double checked_cost(const VectorXd& x) const { return problem_.stable(x) ? problem_.log_cost(x) : kInfinity; }

    /// Peaks and their slopes, without the cost.
    State at(const VectorXd& x) const {
        State state;
        state.x = x;
        state.peaks = problem_.peaks(x);
        for (LimitedPeak& peak : state.peaks) peak.excess += margins_[std::size_t(peak.function)];
        state.excess = -kInfinity;
        for (const LimitedPeak& peak : state.peaks) state.excess = std::max(state.excess, peak.excess);
        std::erase_if(state.peaks, [](const LimitedPeak& peak) { return !(peak.excess > kNear) || !(peak.omega > 0); });
        state.slopes.resize(n_, Index(state.peaks.size()));
        for (Index k = 0; k < state.slopes.cols(); ++k)
            for (Index i = 0; i < n_; ++i) {
                const LimitedPeak& peak = state.peaks[std::size_t(k)];
                VectorXd up = x, down = x;
                up[i] += kOfPeak;
                down[i] -= kOfPeak;
                state.slopes(i, k) = (problem_.excess_at(up, peak.function, peak.omega) -
                                      problem_.excess_at(down, peak.function, peak.omega)) /
                                     (2 * kOfPeak);
            }
        return state;
    }

    /// From a point back to the curved limits, by the shortest steps.
    State corrected(VectorXd x, double most) const {
        State state = at(x.cwiseMax(problem_.low).cwiseMin(problem_.high));
        const VectorXd start = state.x;
        for (int i = 0; i < kCorrections && state.excess > 0 && state.excess < kFar; ++i) {
            LargeProgram program(n_, Index(state.peaks.size()));
            for (std::size_t k = 0; k < state.peaks.size(); ++k)
                program.add(state.slopes.col(Index(k)), -state.peaks[k].excess - kAim);
            const auto minimum = solve(program);
            if (!minimum || (state.x + minimum->x - start).cwiseAbs().maxCoeff() > most) break;
            State next = at((state.x + minimum->x).cwiseMax(problem_.low).cwiseMin(problem_.high));
            if (!(next.excess < state.excess)) break;
            state = std::move(next);
        }
        return state;
    }

    const LimitedProblem& problem_;
    const LimitedOptions& options_;
    const std::vector<double>& margins_;
    Index n_;
    MatrixXd H_;
};

}  // namespace

double merit_of(double log_cost, double excess) { return log_cost + kPenalty * std::max(0.0, excess); }

LimitedResult search_within_limits(const LimitedProblem& problem, const VectorXd& start,
                                   const LimitedOptions& options) {
    std::vector<double> margins(std::size_t(problem.functions), 0.0);
    LimitedResult result = Search(problem, options, margins, options.curvature).run(start);
    for (int round = 1; std::isfinite(result.log_cost); ++round) {
        const bool held = result.excess <= kHeld;
        const std::vector<double> excess = problem.resolved_excess(result.x);
        result.excess = *std::ranges::max_element(excess);
        if (!held || result.excess <= kHeld || result.stopped || round == options.max_rounds) break;
        for (std::size_t i = 0; i < margins.size(); ++i) margins[i] += std::max(0.0, excess[i]);
        result = Search(problem, options, margins, result.curvature).run(result.x);
    }
    return result;
}

}  // namespace tunewright::structure
