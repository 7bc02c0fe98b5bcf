// The plant's input as it was, to be looked at a dead time later.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// w = u + d, controller output and load: 0 before t = 0, then a cubic between neighbouring nodes; after the last node
/// its value is held.
class InputHistory {
public:
    /// `nodes`: of ascending t; must live as long as this. They may grow, and lose their last ones again.
    InputHistory(const std::vector<ResponseNode>& nodes, double d) : nodes_(nodes), d_(d) {}

    /// Limit from the right (`after`) or from the left at t. Nodes within `slack` of t count as being at t.
    Signal at(double t, bool after, double slack);

private:
    const std::vector<ResponseNode>& nodes_;
    double d_;
    std::size_t cursor_ = 0;  // the node that was found last: times are asked for in nearly ascending order
};

}  // namespace tunewright
