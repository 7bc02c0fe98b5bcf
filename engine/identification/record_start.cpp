#include "engine/identification/record_start.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/identification/statistics.h"
#include "engine/identification/uncertainty.h"

namespace tunewright {

Start start_of(const CleanRecord& r) {
    constexpr std::size_t kFewest = 5;
    constexpr double kErrors = 5, kMoved = 0.05;
    if (r.u0_given) return Start::at_rest;
    const auto n = static_cast<std::size_t>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin());
    if (n < kFewest || r.t[n - 1] <= r.t[0]) return r.changes() == 1 ? Start::at_rest : Start::unseen;
    const std::span t(r.t.data(), n), y(r.y.data(), n);
    const Line line = straight_line(t, y);
    if (std::abs(line.slope) * (r.t.back() - r.t[0]) < kMoved) return Start::at_rest;
    std::vector<double> left;
    for (std::size_t i = 0; i < n; ++i) left.push_back(y[i] - line.y_mean - line.slope * (t[i] - line.t_mean));
    const double error = line.slope_std * std::sqrt(correlation_time(left));
    return std::abs(line.slope) > kErrors * error ? Start::moving : Start::at_rest;
}

}  // namespace tunewright
