// Limits on the peaks of a loop, and by how much a loop exceeds them.
#pragma once

#include <algorithm>
#include <optional>

#include "engine/loop/peaks.h"
#include "engine/tuning/limits.h"

namespace tunewright {

struct PeakLimits {
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;  ///< > 1
    std::optional<double> Mks;                                ///< of max |C S|
    bool m_circle = false;  ///< one circle around the circles of Ms and Mt in their place
};

/// The largest relative excess over a limit; <= 0: all hold. The circles are checked one by one.
inline double excess_of(const Peaks& peaks, const PeakLimits& limits) {
    const double circles = std::max(peaks.S.value / limits.Ms, peaks.T.value / limits.Mt);
    return (limits.Mks ? std::max(circles, peaks.CS.value / *limits.Mks) : circles) - 1;
}

}  // namespace tunewright
