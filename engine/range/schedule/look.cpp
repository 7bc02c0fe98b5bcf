#include "engine/range/schedule/look.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include "engine/tuning/limits.h"

#include "engine/tuning/robust/sqp.h"

namespace tunewright::range {
namespace {

constexpr double kAllPeaks = -5;         // of ln of a limit's ratio: every peak counts
constexpr double kHighPeaks = -0.05;     // of it: only what may exceed the limit somewhere near
constexpr double kLookTolerance = 3e-4;  // of the simulations
constexpr double kFineTolerance = 1e-5;
constexpr double kWorst = std::numeric_limits<double>::infinity();

void add_setting(Look& look, const Place& place, const robust::DesignPoint& x, double log_own_IAE, double above) {
    const robust::Limits& limits = place.problem().limits;
    for (const auto& peak : place.sweep().peaks(x, above)) {
        look.excess = std::max(look.excess, peak.value);
        if (peak.kind == robust::ConstraintKind::S) look.Ms = std::max(look.Ms, limits.Ms * std::exp(peak.value));
        if (peak.kind == robust::ConstraintKind::T) look.Mt = std::max(look.Mt, limits.Mt * std::exp(peak.value));
    }
    look.stable = look.stable && robust::is_stable(place.problem(), x);
    double log_IAE = look.stable ? robust::log_cost(place.problem(), x, kLookTolerance) : kWorst;
    // A run that is coarse may miss that a slow tail has settled.
    if (look.stable && !std::isfinite(log_IAE)) log_IAE = robust::log_cost(place.problem(), x, kFineTolerance);
    look.log_price = std::max(look.log_price, log_IAE - log_own_IAE);
}

}  // namespace

robust::DesignPoint point_of(const IdealPid& pid) {
    return {std::log(std::abs(pid.Kp)), std::log(pid.Ti), pid.Td > 0 ? std::log(pid.Td) : -kWorst};
}

std::vector<IdealPid> in_use(const Schedule& schedule, double at) {
    if (schedule.interpolation != Interpolation::steps) return {settings_at(schedule, at)};
    std::vector<IdealPid> result;
    const double half = 0.5 * schedule.hysteresis;
    for (std::size_t k = 0; k < schedule.rows.size(); ++k) {
        const bool above = k == 0 || at >= schedule.rows[k].at - half;
        const bool below = k + 1 == schedule.rows.size() || at <= schedule.rows[k + 1].at + half;
        if (above && below) result.push_back(controller_of(schedule.rows[k]));
    }
    return result;
}

Look look_at(const Place& place, const std::vector<IdealPid>& settings, double log_own_IAE, bool all_peaks) {
    const double above = all_peaks ? kAllPeaks : kHighPeaks;
    Look look{.at = place.at(), .stable = true, .Ms = 1, .Mt = 0, .excess = above, .log_price = -kWorst};
    for (const IdealPid& pid : settings) add_setting(look, place, point_of(pid), log_own_IAE, above);
    if (!look.stable) look.excess = look.log_price = kWorst;
    return look;
}

Expected<Look> look_between(const Places& places, const OwnOptima& own, const std::vector<IdealPid>& settings,
                            double at, bool all_peaks) {
    auto model = places.model().at(at);
    if (!model) return model.error();
    const Place place(std::move(*model), places.rules());
    return look_at(place, settings, own.log_IAE(at), all_peaks);
}

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
