// The instants at which a dead time brings a jump back to the plant.
#pragma once

#include <algorithm>
#include <map>
#include <optional>

namespace tunewright {

/// A jump is smoothed at each passage through the plant; after `most` of them it counts no more.
class BreakPoints {
public:
    explicit BreakPoints(int most) : most_(most) {}

    /// Points nearer than `slack` are one.
    void add(double t, int passages, double slack) {
        if (passages > most_) return;
        const auto near = points_.lower_bound(t - slack);
        if (near != points_.end() && near->first <= t + slack)
            near->second = std::min(near->second, passages);
        else
            points_.emplace(t, passages);
    }

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
