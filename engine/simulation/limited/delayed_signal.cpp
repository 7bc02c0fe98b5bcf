#include "engine/simulation/limited/delayed_signal.h"

#include <cmath>

#include "engine/numerics/propagator.h"

namespace tunewright {

using Index = std::size_t;

Signal DelayedSignal::at(double t, bool after, double slack) {
    if (t < -slack || (t <= slack && !after)) return {};
    while (cursor_ + 1 < nodes_.size() && nodes_[cursor_ + 1].t < t - slack) ++cursor_;
    while (cursor_ > 0 && nodes_[cursor_].t > t + slack) --cursor_;
    // Exactly on a node: the last of equal times after a jump, the first before it.
    for (Index i = cursor_; i < nodes_.size() && nodes_[i].t <= t + slack; ++i) {
        if (std::abs(nodes_[i].t - t) > slack) continue;
        Index hit = i;
        if (after)
            while (hit + 1 < nodes_.size() && std::abs(nodes_[hit + 1].t - t) <= slack) ++hit;
        else
            while (hit > 0 && std::abs(nodes_[hit - 1].t - t) <= slack) --hit;
        return {nodes_[hit].u + d_, nodes_[hit].u_slope};
    }
    Index left = cursor_;
    while (left + 1 < nodes_.size() && nodes_[left + 1].t <= t) ++left;
    if (left + 1 >= nodes_.size()) return {nodes_.back().u + d_, nodes_.back().u_slope};
    const ResponseNode &a = nodes_[left], &b = nodes_[left + 1];
    const double h = b.t - a.t, s = t - a.t;
    const auto c = hermite_taylor(h, a.u, a.u_slope, b.u, b.u_slope);
    return {value_at(c, s) + d_, slope_at(c, s)};
}

}  // namespace tunewright
