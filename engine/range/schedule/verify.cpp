#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/range/schedule/look.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {
namespace {

constexpr int kLooks = 48;             // places over the range at which a schedule is verified first
constexpr int kLooksOfPart = 9;        // and between two places where plant or settings bend
constexpr double kSmallExcess = 5e-4;  // of it: all limits are tightened by it, rather than a place added
constexpr double kNearLimit = -5e-3;   // of it: tops above it are looked at more closely
constexpr double kNearPrice = 0.01;    // of ln of the price, below what is allowed: the same
constexpr std::size_t kMostAdded = 6;  // places a round

std::vector<double> looked_at(const Places& places, const Schedule& schedule) {
    const double low = places.model().low(), high = places.model().high();
    std::vector<double> at;
    for (int i = 0; i <= kLooks; ++i) at.push_back(low + (high - low) * i / kLooks);
    const std::vector<double> bends = bends_of(places.model(), schedule);
    at.insert(at.end(), bends.begin(), bends.end());
    for (std::size_t k = 1; k < bends.size(); ++k) {
        const double from = bends[k - 1], width = bends[k] - from;
        for (int i = 0; i < kLooksOfPart; ++i) at.push_back(from + width * (i + 0.5) / kLooksOfPart);
    }
    std::ranges::sort(at);
    at.erase(std::ranges::unique(at).begin(), at.end());
    return at;
}

/// Looks over the range, ascending, and more of them where they are near a limit or the price allowed.
class Looks {
public:
    Looks(const Places& places, const OwnOptima& own, const Schedule& schedule)
        : places_(places), own_(own), schedule_(schedule) {}

    std::optional<Error> take(double at) {
        const auto look = look_between(places_, own_, in_use(schedule_, at), at, false);
        if (!look) return look.error();
        const auto after = std::ranges::upper_bound(looks_, at, {}, &Look::at);
        looks_.insert(after, *look);
        return std::nullopt;
    }

    /// One more look at the top of the parabola through each local maximum above the threshold and its neighbours.
    std::optional<Error> refine(double Look::*value, double threshold) {
        std::vector<double> wanted;
        for (std::size_t i = 1; i + 1 < looks_.size(); ++i) {
            const Look &a = looks_[i - 1], &b = looks_[i], &c = looks_[i + 1];
            if (!is_top(i, value) || !(b.*value > threshold) || !std::isfinite(a.*value + b.*value + c.*value))
                continue;
            const double left = (b.*value - a.*value) / (b.at - a.at), right = (c.*value - b.*value) / (c.at - b.at);
            const double bend = (right - left) / (c.at - a.at);
            if (!(bend < 0)) continue;
            const double top = 0.5 * (a.at + b.at) - 0.5 * left / bend;
            if (top > a.at && top < c.at && top != b.at) wanted.push_back(top);
        }
        for (const double at : wanted)
            if (auto error = take(at)) return error;
        return std::nullopt;
    }

    double largest(double Look::*value) const { return (*std::ranges::max_element(looks_, {}, value)).*value; }

    /// Local maxima above the threshold, the largest first.
    std::vector<double> tops(double Look::*value, double threshold) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < looks_.size(); ++i)
            if (looks_[i].*value > threshold && (is_top(i, value) || !std::isfinite(looks_[i].*value)))
                found.push_back(i);
        std::ranges::stable_sort(found, std::greater{}, [&](std::size_t i) { return looks_[i].*value; });
        found.resize(std::min(found.size(), kMostAdded));
        std::vector<double> at;
        for (const std::size_t i : found) at.push_back(looks_[i].at);
        return at;
    }

private:
    bool is_top(std::size_t i, double Look::*value) const {
        const double here = looks_[i].*value;
        return (i == 0 || looks_[i - 1].*value <= here) && (i + 1 == looks_.size() || looks_[i + 1].*value < here);
    }

    const Places& places_;
    const OwnOptima& own_;
    const Schedule& schedule_;
    std::vector<Look> looks_;
};

}  // namespace

std::vector<double> bends_of(const RangeModel& model, const Schedule& schedule) {
    std::vector<double> bends = model.points();
    for (const ScheduleRow& row : schedule.rows)
        if (row.at >= model.low() && row.at <= model.high()) bends.push_back(row.at);
    std::ranges::sort(bends);
    bends.erase(std::ranges::unique(bends).begin(), bends.end());
    return bends;
}

Expected<Verified> verify(const Places& places, const OwnOptima& own, const Schedule& schedule, double allowed) {
    Looks looks(places, own, schedule);
    for (const double at : looked_at(places, schedule))
        if (auto error = looks.take(at)) return *error;
    for (int round = 0; round < 2; ++round) {
        if (auto error = looks.refine(&Look::excess, kNearLimit)) return *error;
        if (auto error = looks.refine(&Look::log_price, allowed - kNearPrice)) return *error;
    }
    Verified result{.excess = looks.largest(&Look::excess), .log_price = looks.largest(&Look::log_price), .worst = {}};
    const bool little = result.excess <= kSmallExcess && result.log_price <= allowed;
    if (!little) result.worst = looks.tops(&Look::excess, limits::kMaxRelativeExcessVerified);
    const auto dear = looks.tops(&Look::log_price, allowed);
    result.worst.insert(result.worst.end(), dear.begin(), dear.end());
    return result;
}

}  // namespace tunewright::range
