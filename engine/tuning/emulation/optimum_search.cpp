#include "engine/tuning/emulation/optimum_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/evaluation/best_so_far.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/numerics/optimise/levenberg_marquardt.h"
#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright::emulation {

namespace {

// The figures of a design for the progress: on the linearisation, for a unit load. Null if that loop is unstable.
std::shared_ptr<const BestSoFar> best_so_far(const LinearPlant& plant, const IdealPid& pid) {
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return nullptr;
    if (plant.dead_time() > 0 && loop->high_frequency_gain() >= 1) return nullptr;
    const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
    const auto response = simulate_linear(plant, loop->gains(), {0, 1}, {});
    if (!response.settles) return nullptr;
    const auto integrals = error_integrals(response.nodes, 0, response.error_integral_final);
    return std::make_shared<const BestSoFar>(BestSoFar{pid, integrals.IAE, peaks.S.value, peaks.T.value});
}

constexpr double kCoarseTolerance = 1e-6;        // of simulations in the global search
constexpr double kSearchTolerance = 1e-8;        // of simulations for differences
constexpr int kExplored[] = {0, 0, 30, 60, 90};  // points of the global search, by the number of unknowns
constexpr int kPolishedStarts = 2;               // starts that get a local search
constexpr double kMinStartDistance = 0.05;       // between two of them, in a unit box
constexpr int kMaxPolishSteps = 25;
constexpr double kDifference = 1e-4;        // of a derivative, relative to the unknown
constexpr double kMinExpectedFall = 1e-10;  // expected decrease of J, relative, at which a local search ends
// A simulation is expensive, and few of them reach `kMinExpectedFall`: with more damping a step gains less than its
// simulations cost.
constexpr optimise::MarquardtDamping kDamping = {.max = 1e8, .ease = 10, .tighten = 10};
constexpr double kMaxConfidentDamping = 10;  // damping up to which a small expected decrease means that J is flat
constexpr double kMaxPolishStep = 0.5;       // relative to the unknown
constexpr double kSubplexStep = 0.02;        // in a unit box
constexpr double kUnexploredLogJ = 700;      // ln J of a point after the search was stopped
constexpr double kMinJ = 1e-300;             // keeps the logarithm of an exact emulation finite
constexpr int kSubplexEvaluations = 150;
constexpr double kSubplexTolerance = 1e-9;
constexpr double kLogarithmicFrom = 3;  // ratio high/low above which a bound's scale is logarithmic

// One unknown between its bounds as 0 to 1.
class Scale {
public:
    Scale(double low, double high)
        : low_(low), high_(high), logarithmic_(low * high > 0 && ratio(low, high) > kLogarithmicFrom) {}
    double from_unit(double q) const {
        if (q <= 0) return low_;
        if (q >= 1) return high_;
        return logarithmic_ ? low_ * std::pow(high_ / low_, q) : low_ + q * (high_ - low_);
    }
    double to_unit(double x) const {
        return logarithmic_ ? std::log(x / low_) / std::log(high_ / low_) : (x - low_) / (high_ - low_);
    }

private:
    static double ratio(double low, double high) { return std::max(high / low, low / high); }
    double low_, high_;
    bool logarithmic_;
};

class SettingsSearch {
public:
    SettingsSearch(const Criterion& criterion, const Bounds& bounds, const RunControl& control)
        : criterion_(criterion), bounds_(bounds), control_(control) {
        for (std::size_t i = 0; i < bounds.low.size(); ++i) scales_.emplace_back(bounds.low[i], bounds.high[i]);
    }

    std::optional<Optimum> run(const std::vector<SettingsPoint>& starts) {
        std::vector<LocalMinimum> met = look_around();
        for (const SettingsPoint& start : starts) {
            if (stopped()) break;
            const SettingsPoint inside = clipped(start, bounds_);
            met.push_back({units(inside), judged(inside, kCoarseTolerance)});
        }
        if (met.empty()) return std::nullopt;
        std::ranges::stable_sort(met, {}, &LocalMinimum::value);
        std::vector<LocalMinimum> chosen = apart(met);
        best_.point = point_at(chosen.front().x);
        bool flat = false;
        for (std::size_t i = 0; i < chosen.size() && !stopped(); ++i) {
            report(0.4 + 0.2 * static_cast<double>(i), "Refining the emulating controller.");
            const double before = best_value_;
            const bool ended_flat = Polish(*this, point_at(chosen[i].x)).run();
            if (best_value_ < before) flat = ended_flat;
        }
        if (!flat && !stopped()) subplex();
        best_.cost = criterion_.cost(controller_at(criterion_.problem(), best_.point), kFineTolerance);
        best_.stopped = stopped();
        return best_;
    }

private:
    bool stopped() const { return control_.stop.stop_requested(); }
    // Reports with the best design so far, if there is one.
    void report(double fraction, const char* message) const {
        if (!control_.progress) return;
        std::shared_ptr<const BestSoFar> best;
        if (!best_.point.empty())
            best = best_so_far(*criterion_.problem().linear, controller_at(criterion_.problem(), best_.point));
        control_.progress({fraction, "tune", message, best});
    }
    SettingsPoint point_at(const std::vector<double>& q) const {
        SettingsPoint point(q.size());
        for (std::size_t i = 0; i < q.size(); ++i) point[i] = scales_[i].from_unit(q[i]);
        return point;
    }
    std::vector<double> units(const SettingsPoint& point) const {
        std::vector<double> q(point.size());
        for (std::size_t i = 0; i < q.size(); ++i) q[i] = std::clamp(scales_[i].to_unit(point[i]), 0.0, 1.0);
        return q;
    }
    double judged(const SettingsPoint& point, double tolerance) const {
        return criterion_.penalised(
            criterion_.cost(controller_at(criterion_.problem(), point), tolerance, control_.stop));
    }

    std::vector<LocalMinimum> look_around() {
        const auto f = [this](const std::vector<double>& q, bool& stop) {
            stop = stopped();
            return stop ? kUnexploredLogJ : std::log(judged(point_at(q), kCoarseTolerance) + kMinJ);
        };
        const std::size_t n = scales_.size();
        report(0.1, "Searching the emulating controller within the bounds.");
        auto met = explore(f, {std::vector<double>(n, 0), std::vector<double>(n, 1)}, kExplored[n]);
        for (LocalMinimum& point : met) point.value = std::exp(point.value);
        return met;
    }

    std::vector<LocalMinimum> apart(const std::vector<LocalMinimum>& met) const {
        std::vector<LocalMinimum> chosen;
        for (const LocalMinimum& point : met) {
            if (chosen.size() == kPolishedStarts) break;
            const bool close = std::ranges::any_of(chosen, [&](const LocalMinimum& other) {
                double distance = 0;
                for (std::size_t i = 0; i < point.x.size(); ++i)
                    distance = std::max(distance, std::abs(point.x[i] - other.x[i]));
                return distance < kMinStartDistance;
            });
            if (!close) chosen.push_back(point);
        }
        return chosen;
    }

    // A local search from one point, as a problem of `levenberg_marquardt`. Unknowns are steps relative to their sizes
    // at the point.
    class Polish {
    public:
        Polish(SettingsSearch& search, const SettingsPoint& start) : search_(search), point_(start) {
            cost_ = cost_at(start, residuals_);
            search.keep(start, cost_);
        }

        // True if it ends at a point where no decrease is predicted for any step.
        bool run() {
            if (cost_.ended.empty()) optimise::levenberg_marquardt(*this, kMaxPolishSteps, kDamping);
            return flat_;
        }

        bool linearise() {
            const auto n = Eigen::Index(point_.size());
            const auto rows = Eigen::Index(residuals_.size());
            size_ = sizes_of(point_, search_.bounds_);
            Eigen::MatrixXd slopes(rows, n);
            std::vector<double> there;
            for (Eigen::Index i = 0; i < n; ++i) {
                SettingsPoint moved = point_;
                moved[std::size_t(i)] += kDifference * size_[std::size_t(i)];
                if (search_.stopped() || !cost_at(moved, there).ended.empty() || there.size() != residuals_.size())
                    return false;
                slopes.col(i) = (column(there) - column(residuals_)) / kDifference;
            }
            H_ = slopes.transpose() * slopes;
            g_ = slopes.transpose() * column(residuals_);
            return true;
        }

        optimise::Trial try_step(double damping) {
            using optimise::Trial;
            if (search_.stopped()) return Trial::end;
            const SettingsPoint next = stepped(damping);
            const double fall = expected_fall(next);
            flat_ = fall < kMinExpectedFall && damping < kMaxConfidentDamping;
            if (fall < kMinExpectedFall) return Trial::end;
            std::vector<double> residuals;
            const Cost there = cost_at(next, residuals);
            if (!there.ended.empty() || !(there.J < cost_.J)) return Trial::worse;
            point_ = next;
            cost_ = there;
            residuals_ = std::move(residuals);
            search_.keep(point_, cost_);
            return Trial::better;
        }

    private:
        static Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
            return {values.data(), Eigen::Index(values.size())};
        }
        Cost cost_at(const SettingsPoint& point, std::vector<double>& residuals) const {
            const Criterion& criterion = search_.criterion_;
            return criterion.cost(controller_at(criterion.problem(), point), kSearchTolerance, search_.control_.stop,
                                  residuals);
        }

        // The damped step inside the bounds.
        SettingsPoint stepped(double damping) const {
            const auto n = Eigen::Index(point_.size());
            optimise::SmallProgram program(n, 2 * n);
            program.H = optimise::damped(H_, damping, kDamping);
            program.g = g_;
            const Bounds& bounds = search_.bounds_;
            for (Eigen::Index i = 0; i < n; ++i) {
                const auto k = std::size_t(i);
                const auto unit = optimise::SmallProgram::Vector::Unit(n, i);
                program.add(unit, std::clamp((bounds.high[k] - point_[k]) / size_[k], 0.0, kMaxPolishStep));
                program.add(-unit, std::clamp((point_[k] - bounds.low[k]) / size_[k], 0.0, kMaxPolishStep));
            }
            SettingsPoint next = point_;
            if (const auto step = solve(program))
                for (std::size_t i = 0; i < next.size(); ++i) next[i] += step->x[Eigen::Index(i)] * size_[i];
            return clipped(next, bounds);
        }

        // The expected decrease by the step, relative to J.
        double expected_fall(const SettingsPoint& to) const {
            optimise::SmallProgram::Vector d(g_.size());
            for (std::size_t i = 0; i < to.size(); ++i) d[Eigen::Index(i)] = (to[i] - point_[i]) / size_[i];
            return -(2 * g_.dot(d) + d.dot(H_ * d)) / (cost_.J + kMinJ);
        }

        SettingsSearch& search_;
        SettingsPoint point_;
        Cost cost_;
        std::vector<double> residuals_, size_;
        optimise::SmallProgram::Matrix H_;  // J'J of the residuals' derivatives
        optimise::SmallProgram::Vector g_;  // J'r
        bool flat_ = false;
    };

    void keep(const SettingsPoint& point, const Cost& cost) {
        const double value = criterion_.penalised(cost);
        if (value >= best_value_) return;
        best_value_ = value;
        best_.point = point;
    }

    // For a J with kinks from limits of the input.
    void subplex() {
        const auto f = [this](const std::vector<double>& q, bool& stop) {
            stop = stopped();
            if (stop) return kUnexploredLogJ;
            double outside = 0;
            for (const double x : q) outside += std::max(0.0, -x) + std::max(0.0, x - 1);
            const SettingsPoint point = point_at(q);
            const Cost cost =
                criterion_.cost(controller_at(criterion_.problem(), point), kSearchTolerance, control_.stop);
            if (outside == 0) keep(point, cost);
            return std::log(criterion_.penalised(cost) + kMinJ) + outside;
        };
        report(0.8, "Refining the emulating controller.");
        const std::size_t n = scales_.size();
        find_local_minimum(LocalSearch::subplex, f, units(best_.point),
                           {std::vector<double>(n, kSubplexStep), kSubplexTolerance, kSubplexEvaluations});
    }

    const Criterion& criterion_;
    const Bounds& bounds_;
    const RunControl& control_;
    std::vector<Scale> scales_;
    Optimum best_;
    double best_value_ = HUGE_VAL;
};

}  // namespace

std::optional<Optimum> find_optimum(const Criterion& criterion, const Bounds& bounds,
                                    const std::vector<SettingsPoint>& starts, const RunControl& control) {
    return SettingsSearch(criterion, bounds, control).run(starts);
}

}  // namespace tunewright::emulation
