#include "engine/tuning/robust/gain_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright::robust {

double GainGap::middle() const { return lower > 0 ? std::sqrt(lower * upper) : 0.5 * upper; }

std::vector<GainGap> gaps_between(std::vector<GainGap>& forbidden) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::sort(forbidden.begin(), forbidden.end(), [](const GainGap& a, const GainGap& b) { return a.lower < b.lower; });
    std::vector<GainGap> gaps;
    double reached = 0;
    for (const auto& interval : forbidden) {
        if (interval.lower > reached) gaps.push_back({.lower = reached, .upper = interval.lower});
        reached = std::max(reached, interval.upper);
    }
    if (reached < kInfinity) gaps.push_back({.lower = reached, .upper = kInfinity});
    return gaps;
}

}  // namespace tunewright::robust
