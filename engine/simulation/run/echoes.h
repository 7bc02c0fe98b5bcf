// The instants at which a dead time brings a jump of the plant's input back to it, and how often that counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tunewright {

/// The number of passages through the loop after which a jump is no longer met with a step's end. Each passage smooths
/// it by one derivative: after `smoothing` of them the method's order no longer sees it. Where the loop returns a share
/// q (|q| < 1) of the jump at once, it counts until it is below a thousandth of `tolerance`.
inline int echoes_that_count(double q, double tolerance, int smoothing) {
    constexpr int kMaxEchoes = 2000;
    constexpr double kLargestShare = 0.999;  // nearer to 1 the echoes hardly fade within kMaxEchoes
    constexpr double kFaded = 1e-3;          // of the tolerance
    if (!(q > 0)) return smoothing;
    const double passages = std::log(kFaded * tolerance) / std::log(std::min(q, kLargestShare));
    return std::min(kMaxEchoes, smoothing + static_cast<int>(passages));
}

/// The echoes still to come, each with the number of passages since its origin.
class Echoes {
public:
    /// After `most` passages a jump counts no more.
    explicit Echoes(int most) : most_(most) {}

    /// Times nearer than `slack` are one.
    void add(double t, int passages, double slack) {
        if (passages > most_) return;
        const auto near = points_.lower_bound(t - slack);
        if (near != points_.end() && near->first <= t + slack)
            near->second = std::min(near->second, passages);
        else
            points_.emplace(t, passages);
    }

    /// The time of the next one; empty: there is none.
    std::optional<double> next() const {
        return points_.empty() ? std::nullopt : std::optional(points_.begin()->first);
    }

    /// Takes the next one away if it is not after t; its passages so far.
    std::optional<int> pass(double t) {
        if (points_.empty() || points_.begin()->first > t) return std::nullopt;
        const int passages = points_.begin()->second;
        points_.erase(points_.begin());
        return passages;
    }

private:
    int most_;
    std::map<double, int> points_;
};

}  // namespace tunewright
