#include "engine/range/limit_remarks.h"

#include <cmath>
#include <string>

#include "engine/number_text.h"

namespace tunewright::range {
namespace {

constexpr int kMaxDigits = 9;

/// The value and its limit with as many digits as distinguish them.
struct ValueAndLimit {
    std::string value;  ///< "Ms is 1.4002 at load = 3 %"
    std::string limit;
};

ValueAndLimit words_of(const WorstPoint& worst, const PointDesigns& places) {
    const std::string what = worst.quantity == Quantity::Ms ? "Ms" : "Mt";
    if (!worst.value) return {what + " is infinite at " + places.named(worst.at), text(worst.limit)};
    int digits = 4;
    while (digits < kMaxDigits && text(*worst.value, digits) == text(worst.limit, digits)) ++digits;
    return {what + " is " + text(*worst.value, digits) + " at " + places.named(worst.at), text(worst.limit, digits)};
}

}  // namespace

const WorstPoint* worst_limit(const RangeCurve& curve) {
    const WorstPoint* worst = nullptr;
    const auto over = [](const WorstPoint& place) { return place.value.value_or(INFINITY) / place.limit; };
    for (const WorstPoint& place : curve.worst)
        if (place.quantity != Quantity::relative_IAE && (worst == nullptr || over(place) > over(*worst)))
            worst = &place;
    return worst;
}

std::optional<Warning> one_above_limit(const RangeCurve& curve, const PointDesigns& places) {
    if (!exceeds_limit(curve)) return std::nullopt;
    const auto [value, limit] = words_of(*worst_limit(curve), places);
    return Warning{"limit-exceeded-between", "With one setting " + value + " between the points, above its limit of " +
                                                 limit + ". Add a point there."};
}

Warning schedule_above_limit(const RangeCurve& curve, double excess, const PointDesigns& places) {
    const std::string percent = "by " + text(100 * excess, 3) + " %";
    const WorstPoint* worst = worst_limit(curve);
    if (worst != nullptr && (!worst->value || *worst->value > worst->limit)) {
        const auto [value, limit] = words_of(*worst, places);
        return {"schedule-above-limit", "With this schedule " + value + ", above its limit of " + limit +
                                            (std::isfinite(excess) ? " (" + percent + ")." : std::string("."))};
    }
    return {"schedule-above-limit", std::isfinite(excess)
                                        ? "With this schedule a limit is exceeded " + percent + " between its rows."
                                        : std::string("With this schedule a loop between its rows is not stable.")};
}

}  // namespace tunewright::range
