#include "engine/simulation/run/delayed_input.h"

#include <algorithm>
#include <cmath>

namespace tunewright {

Signal InputHistory::at(double t, bool after, double slack) {
    if (t < -slack || (t <= slack && !after)) return {};
    // The first node at t or later.
    std::size_t i = std::min(cursor_, nodes_.size());
    while (i < nodes_.size() && nodes_[i].t < t - slack) ++i;
    while (i > 0 && nodes_[i - 1].t >= t - slack) --i;
    cursor_ = i;
    if (i == nodes_.size()) return {nodes_.back().u + d_, nodes_.back().u_slope};
    if (nodes_[i].t <= t + slack) {
        // Several of equal times are the values before and after a jump.
        while (after && i + 1 < nodes_.size() && nodes_[i + 1].t <= t + slack) ++i;
        return {nodes_[i].u + d_, nodes_[i].u_slope};
    }
    const ResponseNode &a = nodes_[i - 1], &b = nodes_[i];
    const Cubic u = hermite_taylor(b.t - a.t, {a.u, a.u_slope}, {b.u, b.u_slope});
    return {value_at(u, t - a.t) + d_, slope_at(u, t - a.t)};
}

int echoes_that_count(double q, double tolerance, int smoothing) {
    constexpr int kMaxEchoes = 2000;
    constexpr double kLargestShare = 0.999;  // nearer to 1 the echoes hardly fade within kMaxEchoes
    constexpr double kFaded = 1e-3;          // of the tolerance
    if (!(q > 0)) return smoothing;
    const double passages = std::log(kFaded * tolerance) / std::log(std::min(q, kLargestShare));
    return std::min(kMaxEchoes, smoothing + static_cast<int>(passages));
}

}  // namespace tunewright
