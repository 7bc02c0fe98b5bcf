// When a run without a horizon may end, and when it has escaped.
#pragma once

#include <algorithm>
#include <cmath>

namespace tunewright {

/// A response beyond this many times its scale grows without bound.
constexpr double kMaxResponseRatio = 1e6;

/// A response has settled once y and u have stayed near their rest for a quarter of the time that they took, and for
/// two dead times: an echo of what happened last has then been seen.
class StoppingRule {
public:
    /// `fraction`: of the largest deviation, the distance from rest that counts as settled. `dead_time`: of the loop.
    StoppingRule(double fraction, double dead_time) : fraction_(fraction), dead_time_(dead_time) {}

    /// The distances of y and u from rest at time t, and the sizes that they are compared with.
    void note(double t, double dy, double size_y, double du, double size_u) {
        if (dy > fraction_ * size_y || du > fraction_ * size_u) last_unsettled_ = t;
    }
    /// The rest itself has moved at time t.
    void start_again(double t) { last_unsettled_ = t; }

    bool has_settled(double t) const {
        return t > 0 && t >= last_unsettled_ + std::max(2 * dead_time_, kMinQuietShare * last_unsettled_);
    }

    /// A slow tail that has the integral `rest` of the error still to add must at least have the sign to add it: the
    /// error e now, and `whole` the integral in all.
    bool tail_may_end(double rest, double e, double whole) const {
        return rest * e >= 0 || std::abs(rest) <= fraction_ * whole;
    }

private:
    static constexpr double kMinQuietShare = 0.25;  // of the time until the last unsettled value
    double fraction_, dead_time_;
    double last_unsettled_ = 0;
};

}  // namespace tunewright
