#include "engine/identification/record/record_start.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/identification/fit/uncertainty.h"
#include "engine/numerics/statistics.h"

namespace tunewright {

namespace {

/// Whether u comes back to its first level, as that of a relay that is at work from the first row on does.
bool comes_back(const CleanRecord& r) {
    return r.changes() > 1 && std::any_of(r.v_level.begin(), r.v_level.end(), [](double v) { return v == 0; });
}

}  // namespace

Start start_of(const CleanRecord& r, bool relay, double noise) {
    constexpr std::size_t kMin = 5;
    constexpr double kErrors = 5, kVisible = 0.03, kTimesScatter = 4, kInTheEnd = 0.05;
    if (r.u0_given) return Start::at_rest;
    const auto n = static_cast<std::size_t>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin());
    if (n < kMin || r.t[n - 1] <= r.t[0]) return r.changes() == 1 ? Start::at_rest : Start::unseen;
    const std::span t(r.t.data(), n), y(r.y.data(), n);
    if (relay && comes_back(r)) {
        constexpr double kStill = 0.01, kTimesNoise = 6;
        const auto [low, high] = std::minmax_element(y.begin(), y.end());
        return *high - *low <= std::max(kStill, kTimesNoise * noise) ? Start::at_rest : Start::unseen;
    }
    const Line line = straight_line(t, y);
    const double slope = std::abs(line.slope), moved = slope * (t.back() - t[0]);
    if (slope <= kErrors * line.slope_std) return Start::at_rest;
    std::vector<double> left;
    for (std::size_t i = 0; i < n; ++i) left.push_back(y[i] - line.y_mean - line.slope * (t[i] - line.t_mean));
    if (moved > kVisible && moved > kTimesScatter * deviation(left)) return Start::moving;
    const bool certain = slope > kErrors * line.slope_std * std::sqrt(correlation_time(left));
    return certain && slope * (r.t.back() - r.t[0]) > kInTheEnd ? Start::moving : Start::at_rest;
}

}  // namespace tunewright
