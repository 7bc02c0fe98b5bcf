#include "engine/tuning/emulation/optimum_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/evaluation/best_so_far.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/numerics/extremum.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright::emulation {

namespace {

// The figures of a design that progress carries: on the linearisation, for a unit load. Null where that loop is not
// stable.
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

enum class Side { free, low, high };

double value_of(const std::vector<double>& H, const std::vector<double>& g, const std::vector<double>& d) {
    const std::size_t n = g.size();
    double value = 0;
    for (std::size_t i = 0; i < n; ++i) {
        value += g[i] * d[i];
        for (std::size_t j = 0; j < n; ++j) value += 0.5 * H[i * n + j] * d[i] * d[j];
    }
    return value;
}

// Solves for the free unknowns; the others lie on their side.
std::optional<std::vector<double>> with_sides(const std::vector<double>& H, const std::vector<double>& g,
                                              std::vector<double> d, const std::vector<Side>& sides) {
    const std::size_t n = g.size();
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n; ++i)
        if (sides[i] == Side::free) free.push_back(i);
    std::vector<double> matrix, right;
    for (const std::size_t i : free) {
        double b = -g[i];
        for (std::size_t j = 0; j < n; ++j) {
            if (sides[j] == Side::free)
                matrix.push_back(H[i * n + j]);
            else
                b -= H[i * n + j] * d[j];
        }
        right.push_back(b);
    }
    if (free.empty()) return d;
    const auto solved = solve(matrix, right, static_cast<int>(free.size()));
    if (!solved) return std::nullopt;
    for (std::size_t k = 0; k < free.size(); ++k) d[free[k]] = (*solved)[k];
    return d;
}

bool inside(const std::vector<double>& d, const std::vector<double>& low, const std::vector<double>& high) {
    for (std::size_t i = 0; i < d.size(); ++i)
        if (!(d[i] >= low[i] && d[i] <= high[i])) return false;
    return true;
}

// Minimises g.d + d.H d/2 subject to low <= d <= high, by trying every set of active bounds. H is n x n, row by row,
// positive definite; low <= 0 <= high. At most four unknowns.
std::vector<double> best_step_in_box(const std::vector<double>& H, const std::vector<double>& g,
                                     const std::vector<double>& low, const std::vector<double>& high) {
    const std::size_t n = g.size();
    std::vector<double> best(n, 0);
    double least = 0;
    std::size_t combinations = 1;
    for (std::size_t i = 0; i < n; ++i) combinations *= 3;
    for (std::size_t code = 0; code < combinations; ++code) {
        std::vector<Side> sides(n);
        std::vector<double> d(n, 0);
        std::size_t rest = code;
        for (std::size_t i = 0; i < n; ++i, rest /= 3) {
            sides[i] = static_cast<Side>(rest % 3);
            if (sides[i] != Side::free) d[i] = sides[i] == Side::low ? low[i] : high[i];
        }
        const auto candidate = with_sides(H, g, d, sides);
        if (!candidate || !inside(*candidate, low, high)) continue;
        const double value = value_of(H, g, *candidate);
        if (value >= least) continue;
        least = value;
        best = *candidate;
        if (code == 0) break;  // nothing holds it
    }
    return best;
}

constexpr double kCoarseTolerance = 1e-6;        // of simulations while looking around
constexpr double kSearchTolerance = 1e-8;        // of those between which differences are taken
constexpr int kExplored[] = {0, 0, 30, 60, 90};  // points of the global look, by the number of unknowns
constexpr int kPolished = 2;                     // starts that are polished
constexpr double kApart = 0.05;                  // of two of them, in a unit box
constexpr int kMaxPolishSteps = 25;
constexpr double kDifference = 1e-4;    // of a derivative, relative to the unknown
constexpr double kFlat = 1e-10;         // expected fall of J, relative, at which a polish ends
constexpr double kFirstDamping = 1e-3;  // of Levenberg and Marquardt
constexpr double kMinDamping = 1e-9;
constexpr double kMaxDamping = 1e8;
constexpr double kConfident = 10;       // damping up to which a small expected fall means that J is flat
constexpr double kMaxPolishStep = 0.5;  // relative to the unknown
constexpr double kSubplexStep = 0.02;   // in a unit box
constexpr double kNotLookedAt = 700;    // ln J of a point where the search is stopped
constexpr double kLeastJ = 1e-300;      // keeps the logarithm of an exact emulation finite
constexpr int kSubplexEvaluations = 150;
constexpr double kSubplexTolerance = 1e-9;
constexpr double kLogarithmicFrom = 3;  // high/low from which a bound's scale is logarithmic

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
            report(0.4 + 0.2 * static_cast<double>(i), "Polishing the emulating controller.");
            const double before = best_value_;
            const bool ended_flat = polish(point_at(chosen[i].x));
            if (best_value_ < before) flat = ended_flat;
        }
        if (!flat && !stopped()) subplex();
        best_.cost = criterion_.cost(controller_at(criterion_.problem(), best_.point), kFineTolerance);
        best_.stopped = stopped();
        return best_;
    }

private:
    bool stopped() const { return control_.stop.stop_requested(); }
    // With the best design so far, if there is one.
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
            return stop ? kNotLookedAt : std::log(judged(point_at(q), kCoarseTolerance) + kLeastJ);
        };
        const std::size_t n = scales_.size();
        report(0.1, "Looking for the emulating controller within the bounds.");
        auto met = explore(f, {std::vector<double>(n, 0), std::vector<double>(n, 1)}, kExplored[n]);
        for (LocalMinimum& point : met) point.value = std::exp(point.value);
        return met;
    }

    std::vector<LocalMinimum> apart(const std::vector<LocalMinimum>& met) const {
        std::vector<LocalMinimum> chosen;
        for (const LocalMinimum& point : met) {
            if (chosen.size() == kPolished) break;
            const bool close = std::ranges::any_of(chosen, [&](const LocalMinimum& other) {
                double distance = 0;
                for (std::size_t i = 0; i < point.x.size(); ++i)
                    distance = std::max(distance, std::abs(point.x[i] - other.x[i]));
                return distance < kApart;
            });
            if (!close) chosen.push_back(point);
        }
        return chosen;
    }

    // Residuals and their derivatives by the unknowns, each relative to its own size there.
    struct Slope {
        std::vector<double> size, g, H;
    };

    std::optional<Slope> slope_at(const SettingsPoint& point, const std::vector<double>& residuals) const {
        const std::size_t n = point.size();
        std::vector<std::vector<double>> columns(n);
        Slope slope{sizes_of(point, bounds_), std::vector<double>(n, 0), std::vector<double>(n * n, 0)};
        for (std::size_t i = 0; i < n; ++i) {
            SettingsPoint moved = point;
            moved[i] += kDifference * slope.size[i];
            if (stopped()) return std::nullopt;
            const Cost cost = criterion_.cost(controller_at(criterion_.problem(), moved), kSearchTolerance,
                                              control_.stop, columns[i]);
            if (!cost.ended.empty() || columns[i].size() != residuals.size()) return std::nullopt;
            for (std::size_t k = 0; k < residuals.size(); ++k)
                columns[i][k] = (columns[i][k] - residuals[k]) / kDifference;
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < residuals.size(); ++k) slope.g[i] += columns[i][k] * residuals[k];
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = 0;
                for (std::size_t k = 0; k < residuals.size(); ++k) sum += columns[i][k] * columns[j][k];
                slope.H[i * n + j] = slope.H[j * n + i] = sum;
            }
        }
        return slope;
    }

    // Levenberg and Marquardt's step inside the box.
    SettingsPoint stepped(const SettingsPoint& point, const Slope& slope, double damping) const {
        const std::size_t n = point.size();
        std::vector<double> H = slope.H, low(n), high(n);
        for (std::size_t i = 0; i < n; ++i) {
            H[i * n + i] *= 1 + damping;
            low[i] = std::min(0.0, std::max((bounds_.low[i] - point[i]) / slope.size[i], -kMaxPolishStep));
            high[i] = std::max(0.0, std::min((bounds_.high[i] - point[i]) / slope.size[i], kMaxPolishStep));
        }
        const std::vector<double> d = best_step_in_box(H, slope.g, low, high);
        SettingsPoint next = point;
        for (std::size_t i = 0; i < n; ++i) next[i] += d[i] * slope.size[i];
        return clipped(next, bounds_);
    }

    // What the step should gain, relative to J.
    static double expected_fall(const SettingsPoint& from, const SettingsPoint& to, const Slope& slope, double J) {
        const std::size_t n = from.size();
        double fall = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double d = (to[i] - from[i]) / slope.size[i];
            fall -= 2 * slope.g[i] * d;
            for (std::size_t j = 0; j < n; ++j) fall -= d * slope.H[i * n + j] * (to[j] - from[j]) / slope.size[j];
        }
        return fall / (J + kLeastJ);
    }

    // Whether it ends where no step promises anything.
    bool polish(SettingsPoint point) {
        std::vector<double> residuals, tried;
        Cost cost =
            criterion_.cost(controller_at(criterion_.problem(), point), kSearchTolerance, control_.stop, residuals);
        keep(point, cost);
        if (!cost.ended.empty()) return false;
        double damping = kFirstDamping;
        for (int i = 0; i < kMaxPolishSteps; ++i) {
            const auto slope = slope_at(point, residuals);
            if (!slope) return false;
            for (;;) {
                if (stopped()) return false;
                const SettingsPoint next = stepped(point, *slope, damping);
                const double fall = expected_fall(point, next, *slope, cost.J);
                if (fall < kFlat) return damping < kConfident;
                Cost there =
                    criterion_.cost(controller_at(criterion_.problem(), next), kSearchTolerance, control_.stop, tried);
                if (there.ended.empty() && there.J < cost.J) {
                    point = next;
                    cost = there;
                    residuals.swap(tried);
                    keep(point, cost);
                    damping = std::max(kMinDamping, damping / 10);
                    break;
                }
                damping *= 10;
                if (damping > kMaxDamping) return false;
            }
        }
        return false;
    }

    void keep(const SettingsPoint& point, const Cost& cost) {
        const double value = criterion_.penalised(cost);
        if (value >= best_value_) return;
        best_value_ = value;
        best_.point = point;
    }

    // Where limits of the input bend J.
    void subplex() {
        const auto f = [this](const std::vector<double>& q, bool& stop) {
            stop = stopped();
            if (stop) return kNotLookedAt;
            double outside = 0;
            for (const double x : q) outside += std::max(0.0, -x) + std::max(0.0, x - 1);
            const SettingsPoint point = point_at(q);
            const Cost cost =
                criterion_.cost(controller_at(criterion_.problem(), point), kSearchTolerance, control_.stop);
            if (outside == 0) keep(point, cost);
            return std::log(criterion_.penalised(cost) + kLeastJ) + outside;
        };
        report(0.8, "Polishing the emulating controller.");
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
