// What the controller sent out before, looked up as it arrives at the plant a dead time later.
#pragma once

#include <vector>

#include "engine/simulation/linear/response_system.h"

namespace tunewright {

/// w = u + d as it was: nodes in time order, cubic in between, 0 before t = 0.
class DelayedSignal {
public:
    /// `nodes` must live as long as this, and only grow.
    DelayedSignal(const std::vector<ResponseNode>& nodes, double d) : nodes_(nodes), d_(d) {}

    /// Limit from the right (`after`) or left at time t; t never falls from call to call by more than one step.
    Signal at(double t, bool after, double slack);

private:
    const std::vector<ResponseNode>& nodes_;
    double d_;
    std::size_t cursor_ = 0;
};

}  // namespace tunewright
