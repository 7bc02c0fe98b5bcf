// The plant's input as it was, to be looked at a dead time later.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/linear/signal.h"

namespace tunewright {

/// w = u + d as it was: 0 before t = 0, then cubic between the nodes.
class InputHistory {
public:
    InputHistory(const std::vector<ResponseNode>& nodes, double d) : nodes_(nodes), d_(d) {}

    /// Limit from the right (`after`) or from the left.
    Signal at(double t, bool after, double slack) const {
        if (t < -slack || (t <= slack && !after)) return {};
        auto i = std::lower_bound(nodes_.begin(), nodes_.end(), t - slack,
                                  [](const ResponseNode& node, double time) { return node.t < time; });
        if (i == nodes_.end()) return {nodes_.back().u + d_, nodes_.back().u_slope};
        if (i->t <= t + slack) {
            while (after && i + 1 != nodes_.end() && (i + 1)->t <= t + slack) ++i;
            return {i->u + d_, i->u_slope};
        }
        const ResponseNode &a = *(i - 1), &b = *i;
        const auto c = hermite_taylor(b.t - a.t, a.u, a.u_slope, b.u, b.u_slope);
        return {value_at(c, t - a.t) + d_, slope_at(c, t - a.t)};
    }

private:
    const std::vector<ResponseNode>& nodes_;
    double d_;
};

}  // namespace tunewright
