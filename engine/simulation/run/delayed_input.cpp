#include "engine/simulation/run/delayed_input.h"

#include <algorithm>
#include <cmath>

namespace tunewright {

InputHistory::NodePosition InputHistory::near_node(std::size_t i, double t, double slack) const {
    if (t < -slack) return {.first = 0, .last = 0, .rest_before = true, .rest_after = true};
    if (i == nodes_.size()) return {.first = i - 1, .last = i - 1};
    std::size_t last = i;
    while (last + 1 < nodes_.size() && nodes_[last + 1].t <= t + slack) ++last;
    return {.first = i, .last = last, .rest_before = t <= slack};
}

InputHistory::OneSidedLimits InputHistory::at_nodes(const NodePosition& place) const {
    const auto node = [this](std::size_t k) -> Signal { return {nodes_[k].u + d_, nodes_[k].u_slope}; };
    return {place.rest_before ? Signal{} : node(place.first), place.rest_after ? Signal{} : node(place.last)};
}

int echoes_that_count(double q, double tolerance, int smoothing) {
    constexpr int kMaxEchoes = 2000;
    constexpr double kLargestShare = 0.999;  // for a share closer to 1 the echoes hardly fade within kMaxEchoes
    constexpr double kFaded = 1e-3;          // of the tolerance: an echo has faded
    if (!(q > 0)) return smoothing;
    const double passages = std::log(kFaded * tolerance) / std::log(std::min(q, kLargestShare));
    return std::min(kMaxEchoes, smoothing + static_cast<int>(passages));
}

}  // namespace tunewright
