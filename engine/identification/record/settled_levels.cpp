#include "engine/identification/record/settled_levels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/identification/record/record_kind.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr double kLevelTolerance = 0.05;  ///< of u's range

std::string u_text(const CleanRecord& r, double v) { return text(r.scale.u_rest + r.scale.u_scale * v, 4); }
std::string y_text(const CleanRecord& r, double y) { return text(r.scale.y_origin + r.scale.y_scale * y, 4); }
std::string t_text(const CleanRecord& r, double t) { return text(r.scale.t_origin + r.scale.t_scale * t, 4); }

std::optional<Warning> contradiction(const CleanRecord& r, const std::vector<SettledLevel>& levels, double same) {
    constexpr double kMinLevelDistance = 0.25;  // of y's range
    double max = kMinLevelDistance;
    std::optional<Warning> widest;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        for (std::size_t j = i + 1; j < levels.size(); ++j) {
            const SettledLevel &a = levels[i], &b = levels[j];
            if (std::abs(a.u - b.u) > same || std::abs(a.y - b.y) < max) continue;
            max = std::abs(a.y - b.y);
            widest = Warning{"contradictory-levels",
                             "At u = " + u_text(r, a.u) + " y settles at " + y_text(r, a.y) +
                                 " (until t = " + t_text(r, a.until) + "), and at u = " + u_text(r, b.u) + " at " +
                                 y_text(r, b.y) + " (until t = " + t_text(r, b.until) +
                                 "), so y does not depend on u alone. Check whether "
                                 "column u is the input of the plant, and add other inputs that move y as measured "
                                 "disturbances.",
                             WarningLevel::bad};
        }
    }
    return widest;
}

std::optional<Warning> varying_gain(const CleanRecord& r, std::vector<SettledLevel> levels, double same) {
    constexpr double kMaxGainRatio = 1.5;  // multiple of the smallest gain
    std::ranges::sort(levels, {}, &SettledLevel::u);
    std::string gains;
    double min = 0, max = 0;
    int count = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const SettledLevel &a = levels[i - 1], &b = levels[i];
        if (b.u - a.u <= same) continue;
        const double gain = (b.y - a.y) / (b.u - a.u);
        min = count == 0 ? gain : std::min(min, gain), max = count == 0 ? gain : std::max(max, gain);
        gains += (count++ == 0 ? "" : ", ") + text(gain * r.scale.y_scale / r.scale.u_scale, 3) +
                 " from u = " + u_text(r, a.u) + " to " + u_text(r, b.u);
    }
    const bool varies = count > 1 && (min * max < 0 || std::max(std::abs(min), std::abs(max)) >
                                                           kMaxGainRatio * std::min(std::abs(min), std::abs(max)));
    if (!varies) return std::nullopt;
    return Warning{"gain-varies",
                   "The levels at which y settles give different gains over the range of u: " + gains +
                       ". A single model is valid for only one of them: tune each part of the range separately (from, "
                       "to), or tune for the largest gain."};
}

}  // namespace

std::vector<SettledLevel> settled_levels(const CleanRecord& r) {
    constexpr std::size_t kMinSamples = 10;
    constexpr double kQuarter = 0.25, kTenth = 0.1, kMaxStretchShare = 0.03, kMaxRangeShare = 0.02;
    const InputLevels levels = input_levels(r);
    const std::span<const double> all(r.y);
    std::vector<SettledLevel> settled;
    for (std::size_t j = 0; j < levels.level.size(); ++j) {
        const auto at = [&](double time) {
            return static_cast<std::size_t>(std::ranges::lower_bound(r.t, time) - r.t.begin());
        };
        const std::size_t from = at(levels.time[j]),
                          to = j + 1 < levels.level.size() ? at(levels.time[j + 1]) : all.size();
        if (to < from + kMinSamples) continue;
        const auto y = all.subspan(from, to - from);
        const auto n = static_cast<double>(y.size());
        const auto tenth = static_cast<std::size_t>(std::ceil(kTenth * n)),
                   quarter = static_cast<std::size_t>(std::ceil(kQuarter * n));
        const double end = mean(y.last(tenth)), late = mean(y.last(quarter).first(tenth));
        const auto [low, high] = std::ranges::minmax(y);
        if (std::abs(end - late) > std::max(kMaxStretchShare * (high - low), kMaxRangeShare)) continue;
        settled.push_back({levels.level[j], end, r.t[to - 1]});
    }
    return settled;
}

std::optional<Warning> level_warning(const CleanRecord& r) {
    const std::vector<SettledLevel> levels = settled_levels(r);
    if (levels.size() < 2) return std::nullopt;
    const auto [low, high] = std::ranges::minmax(r.v_level);
    const double same = kLevelTolerance * (std::max(high, 0.0) - std::min(low, 0.0));
    if (auto warning = contradiction(r, levels, same)) return warning;
    return varying_gain(r, levels, same);
}

}  // namespace tunewright
