// Decides when a run without a horizon ends, and when its response is unbounded.
#pragma once

#include <algorithm>
#include <cmath>

namespace tunewright {

/// A response that exceeds its scale by this factor counts as unbounded.
constexpr double kMaxResponseRatio = 1e6;

/// A response has settled once y and u have stayed near their rest for a quarter of the time before, and for two dead
/// times, so that an echo of the last event would have appeared.
class StoppingRule {
public:
    /// `fraction`: distance from rest that counts as settled, relative to the largest deviation. `dead_time`: of the
    /// loop.
    StoppingRule(double fraction, double dead_time) : fraction_(fraction), dead_time_(dead_time) {}

    /// Updates the rule with the distances of y and u from rest at time t, and the sizes to compare them with.
    void note(double t, double dy, double size_y, double du, double size_u) {
        if (dy > fraction_ * size_y || du > fraction_ * size_u) last_unsettled_ = t;
    }
    /// The rest itself has changed at time t.
    void start_again(double t) { last_unsettled_ = t; }

    bool has_settled(double t) const {
        return t > 0 && t >= last_unsettled_ + std::max(2 * dead_time_, kMinQuietShare * last_unsettled_);
    }

    /// For a slow tail: its remaining integral `rest` must have the sign of the error e now; `whole` is the total
    /// integral.
    bool tail_may_end(double rest, double e, double whole) const {
        return rest * e >= 0 || std::abs(rest) <= fraction_ * whole;
    }

private:
    static constexpr double kMinQuietShare = 0.25;  // of the time up to the last unsettled value
    double fraction_, dead_time_;
    double last_unsettled_ = 0;
};

}  // namespace tunewright
