// The plant's input after the dead time: its values, and the times at which its jumps return.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// For responses that are stored as nodes; those on nonlinear plants are polynomials of degree 5, which
/// numerics/step_polynomial.h evaluates.
///
/// w = u + d, controller output and load: 0 before t = 0, then a cubic between neighbouring nodes; after the last node
/// its value is held.
///
/// The look-up is in the header because a function call would cost a response a seventh.
class InputHistory {
public:
    /// `nodes`: of ascending t; must outlive this. Nodes may be added, and the last ones removed.
    InputHistory(const std::vector<ResponseNode>& nodes, double d) : nodes_(nodes), d_(d) {}

    /// The position of a time: strictly between two neighbouring nodes, or at nodes of equal times: the first
    /// has the value before a jump and the last the one after it.
    struct NodePosition {
        std::size_t first, last;
        bool between = false;
        bool rest_before = false, rest_after = false;  ///< true: 0 takes the place of the node, before the first one
    };
    /// Nodes within `slack` of t count as being at t.
    NodePosition find(double t, double slack) {
        const std::size_t i = first_from(t, slack);
        if (is_node(i, t, slack)) return near_node(i, t, slack);
        return {.first = i - 1, .last = i, .between = true};
    }

    struct OneSidedLimits {
        Signal before, after;
    };
    /// Limits from the left and from the right at t.
    OneSidedLimits at(double t, double slack) {
        const std::size_t i = first_from(t, slack);
        if (is_node(i, t, slack)) return at_nodes(near_node(i, t, slack));
        const ResponseNode &a = nodes_[i - 1], &b = nodes_[i];
        const Cubic u = hermite_taylor(b.t - a.t, {a.u, a.u_slope}, {b.u, b.u_slope});
        const Signal between{value_at(u, t - a.t) + d_, slope_at(u, t - a.t)};
        return {between, between};
    }

private:
    /// The first node at t or later; the number of nodes if there is none.
    std::size_t first_from(double t, double slack);
    bool is_node(std::size_t i, double t, double slack) const {
        return i == 0 || i == nodes_.size() || nodes_[i].t <= t + slack;
    }
    NodePosition near_node(std::size_t i, double t, double slack) const;
    OneSidedLimits at_nodes(const NodePosition& place) const;

    const std::vector<ResponseNode>& nodes_;
    double d_;
    std::size_t cursor_ = 0;  // index of the last result, because times are requested in nearly ascending order
};

inline std::size_t InputHistory::first_from(double t, double slack) {
    std::size_t i = std::min(cursor_, nodes_.size());
    while (i < nodes_.size() && nodes_[i].t < t - slack) ++i;
    while (i > 0 && nodes_[i - 1].t >= t - slack) --i;
    return cursor_ = i;
}

/// The number of passages through the loop after which steps need not end at a jump. Each passage smooths it by one
/// derivative: after `smoothing` of them it no longer affects a method of this order. If the loop returns a share q
/// (|q| < 1) of the jump directly, it counts until it is below a thousandth of `tolerance`.
int echoes_that_count(double q, double tolerance, int smoothing);

/// The future echoes, each with the number of passages since its origin.
class Echoes {
public:
    /// After `max` passages a jump no longer counts.
    explicit Echoes(int max) : max_(max) {}

    /// Times closer than `slack` are equal.
    void add(double t, int passages, double slack) {
        if (passages > max_) return;
        const auto near = points_.lower_bound(t - slack);
        if (near != points_.end() && near->first <= t + slack)
            near->second = std::min(near->second, passages);
        else
            points_.emplace(t, passages);
    }

    /// The time of the next echo; empty: there is none.
    std::optional<double> next() const {
        return points_.empty() ? std::nullopt : std::optional(points_.begin()->first);
    }

    /// Removes the next echo if it is not after t, and returns its passages so far.
    std::optional<int> pass(double t) {
        if (points_.empty() || points_.begin()->first > t) return std::nullopt;
        const int passages = points_.begin()->second;
        points_.erase(points_.begin());
        return passages;
    }

private:
    int max_;
    std::map<double, int> points_;
};

}  // namespace tunewright
