#include "engine/range/schedule/own_optima.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/optimise/line_search.h"

namespace tunewright::range {
namespace {

constexpr std::size_t kMinRangePoints = 7;
constexpr double kMaxLogStep = 0.3;                // difference of ln Kp, ln Ti, ln IAE between neighbours
constexpr int kGridPoints = 161;                   // points of a layout
constexpr int kHalvings = 14;                      // halvings of its error
constexpr double kMinRelativeSpacing = 1.0 / 512;  // of the range: closer neighbours are not divided further

double difference(const PointDesign& a, const PointDesign& b) {
    return std::max({std::abs(a.optimum()[0] - b.optimum()[0]), std::abs(a.optimum()[1] - b.optimum()[1]),
                     std::abs(a.optimum_log_cost() - b.optimum_log_cost())});
}

/// Slope at row i from the parabola through it and its neighbours (the nearest three at an end).
double parabola_slope(const std::vector<double>& x, const std::vector<double>& f, std::size_t i) {
    const std::size_t n = x.size(), m = std::clamp<std::size_t>(i, 1, n - 2);
    const double left = (f[m] - f[m - 1]) / (x[m] - x[m - 1]), right = (f[m + 1] - f[m]) / (x[m + 1] - x[m]);
    const double bend = (right - left) / (x[m + 1] - x[m - 1]);
    return left + bend * (2 * x[i] - x[m - 1] - x[m]);
}

}  // namespace

Expected<OwnOptima> OwnOptima::over(PointDesigns& places, std::size_t max_places) {
    const RangeModel& model = places.model();
    for (const double at : model.points())
        if (const auto place = places.at(at); !place) return place.error();
    const double min = kMinRelativeSpacing * (model.high() - model.low());
    for (std::size_t count = places.known().size(); count < max_places; ++count) {
        // Next point: between the neighbours that differ most, or in the widest gap while there are few.
        const auto known = places.known();
        double max = 0, middle = 0;
        for (std::size_t i = 1; i < known.size(); ++i) {
            const double width = known[i]->at() - known[i - 1]->at();
            if (width < min) continue;
            const double share = width / (model.high() - model.low());
            const double worth =
                std::max(difference(*known[i - 1], *known[i]), count < kMinRangePoints ? share + 1 : 0);
            if (worth <= max) continue;
            max = worth;
            middle = 0.5 * (known[i]->at() + known[i - 1]->at());
        }
        if (max <= kMaxLogStep) break;
        if (const auto place = places.at(middle); !place) return place.error();
    }
    OwnOptima table;
    table.renew(places);
    return table;
}

void OwnOptima::renew(const PointDesigns& places) {
    *this = {};
    for (const PointDesign* place : places.known()) {
        at_.push_back(place->at());
        rows_.push_back(place->optimum());
        for (std::size_t k = 0; k < 3; ++k) x_[k].push_back(place->optimum()[k]);
        log_IAE_.push_back(place->optimum_log_cost());
    }
}

double OwnOptima::interpolated(const std::vector<double>& value, double at) const {
    const auto after = std::upper_bound(at_.begin() + 1, at_.end() - 1, at);
    const auto i = std::size_t(after - at_.begin()) - 1;
    const double h = at_[i + 1] - at_[i], s = std::clamp((at - at_[i]) / h, 0.0, 1.0);
    const double a = h * parabola_slope(at_, value, i), b = h * parabola_slope(at_, value, i + 1);
    const double f = value[i], g = value[i + 1];
    return f + s * (a + s * (3 * (g - f) - 2 * a - b + s * (2 * (f - g) + a + b)));
}

double OwnOptima::log_IAE(double at) const { return interpolated(log_IAE_, at); }

robust::DesignPoint OwnOptima::optimum(double at) const {
    return {interpolated(x_[0], at), interpolated(x_[1], at), interpolated(x_[2], at)};
}

OwnOptima::Grid OwnOptima::fine_grid() const {
    Grid grid;
    for (int i = 0; i < kGridPoints; ++i) {
        grid.at.push_back(at_.front() + (at_.back() - at_.front()) * i / (kGridPoints - 1));
        grid.x.push_back(optimum(grid.at.back()));
    }
    return grid;
}

namespace {

/// Errors of a part's settings against the optima between grid points i and j.
class Parts {
public:
    Parts(const std::vector<double>& at, const std::vector<robust::DesignPoint>& x, Interpolation interpolation)
        : at_(at), interpolation_(interpolation) {
        for (const auto& point : x) {
            Kp_.push_back(std::exp(point[0]));
            Ti_.push_back(std::exp(point[1]));
        }
    }

    double spread(std::size_t i, std::size_t j) const {
        double low[2] = {1, 1}, high[2] = {1, 1};
        for (std::size_t k = i; k <= j; ++k) {
            const double share = (at_[k] - at_[i]) / (at_[j] - at_[i]);
            double Kp = Kp_[i], Ti = Ti_[i];
            if (interpolation_ != Interpolation::steps) {
                Kp += share * (Kp_[j] - Kp_[i]);
                Ti = interpolation_ == Interpolation::linear_in_gains
                         ? 1 / (1 / Ti_[i] + share * (1 / Ti_[j] - 1 / Ti_[i]))
                         : Ti_[i] + share * (Ti_[j] - Ti_[i]);
            }
            const double off[2] = {Kp / Kp_[k], Kp / Kp_[k] * Ti_[k] / Ti};
            for (int q = 0; q < 2; ++q) {
                low[q] = std::min(low[q], off[q]);
                high[q] = std::max(high[q], off[q]);
            }
        }
        return 0.5 * std::log(std::max(high[0] / low[0], high[1] / low[1]));
    }

    /// The farthest grid point that one part from i reaches with at most this error.
    std::size_t reach(std::size_t i, double error) const {
        std::size_t good = i + 1, bad = at_.size();
        while (bad - good > 1) {
            const std::size_t middle = (good + bad) / 2;
            (spread(i, middle) <= error ? good : bad) = middle;
        }
        return good;
    }

    /// The ends of the fewest parts with at most this error; empty if they are more than `max`.
    std::vector<std::size_t> cover(double error, std::size_t max) const {
        std::vector<std::size_t> ends = {0};
        while (ends.back() + 1 < at_.size()) {
            if (ends.size() > max) return {};
            ends.push_back(reach(ends.back(), error));
        }
        return ends;
    }

private:
    const std::vector<double>& at_;
    Interpolation interpolation_;
    std::vector<double> Kp_, Ti_;
};

}  // namespace

OwnOptima::Layout OwnOptima::layout(int rows, Interpolation interpolation) const {
    const Grid grid = fine_grid();
    const Parts parts(grid.at, grid.x, interpolation);
    const bool steps = interpolation == Interpolation::steps;
    const auto max = std::size_t(std::max(1, steps ? rows : rows - 1));
    const auto covers = [&](double spread) { return !parts.cover(spread, max).empty(); };
    const double high = bisect({parts.spread(0, grid.at.size() - 1), 0}, covers, kHalvings).inside;
    Layout layout{.at = {}, .error = high};
    auto ends = parts.cover(high, max);
    // The error need not grow with the length of a part: halving a part may then miss that one part covers the whole
    // range.
    if (ends.empty()) ends = {0, grid.at.size() - 1};
    for (const std::size_t end : ends) layout.at.push_back(grid.at[end]);
    if (steps) layout.at.pop_back();
    return layout;
}

}  // namespace tunewright::range
