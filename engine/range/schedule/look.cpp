#include "engine/range/schedule/look.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace tunewright::range
