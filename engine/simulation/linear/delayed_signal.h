// The delayed signal at the ends of a run's steps.
#pragma once

#include <cmath>
#include <limits>

#include "engine/simulation/run/delayed_input.h"

namespace tunewright {

constexpr double kSameInstant = 1e-9;  // of the shortest step: closer times are equal

class DelayedSignal {
public:
    /// `L`: the dead time. `h0`: the shortest step. `nodes`: of the run, which must outlive this; `d`: its load.
    DelayedSignal(const std::vector<ResponseNode>& nodes, double d, double L, double h0)
        : history_(nodes, d), L_(L), slack_(kSameInstant * h0) {}

    /// At the start of a step, after a jump there.
    Signal from(double t) {
        if (std::abs(looked_up_ - t) <= slack_) return after_;
        return history_.at(t - L_, slack_).after;
    }

    /// At the end of a step, before a jump there.
    Signal until(double t) {
        const auto [before, after] = history_.at(t - L_, slack_);
        looked_up_ = t;
        after_ = after;
        return before;
    }

private:
    InputHistory history_;
    double L_, slack_;
    double looked_up_ = -std::numeric_limits<double>::infinity();  // end of the last step
    Signal after_;                                                 // there
};

}  // namespace tunewright
