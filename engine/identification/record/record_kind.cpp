#include "engine/identification/record/record_kind.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr int kMinSwitches = 3;  ///< a whole period of a relay
constexpr int kMaxSteps = 20;    ///< more moves are not manual steps

double spread(const std::vector<double>& x) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    return *high - *low;
}

/// y just before `time`: the relay's input when it switched.
double y_before(const CleanRecord& r, double time) {
    constexpr double kTimeTolerance = 1e-12;  // of the record's length
    const auto at = std::upper_bound(r.t.begin(), r.t.end(), time + kTimeTolerance);
    return r.y[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, at - r.t.begin() - 1))];
}

/// Mean of y over the samples of [from, to], or the value before `to` if there are none.
double y_mean(const CleanRecord& r, double from, double to) {
    const auto first = std::lower_bound(r.t.begin(), r.t.end(), from), last = std::upper_bound(first, r.t.end(), to);
    if (first == last) return y_before(r, to);
    const auto start = r.y.begin() + (first - r.t.begin());
    return std::accumulate(start, start + (last - first), 0.0) / static_cast<double>(last - first);
}

/// Half periods between switches, separately for the two levels, without the first of each, because the start is not
/// steady.
struct HalfPeriods {
    std::vector<double> of[2];
};

HalfPeriods half_periods(const TwoLevels& u) {
    HalfPeriods halves;
    for (std::size_t k = 1; k < u.switch_time.size(); ++k)
        halves.of[k % 2].push_back(u.switch_time[k] - u.switch_time[k - 1]);
    for (auto& half : halves.of) {
        if (half.size() > 2) half.erase(half.begin());
    }
    return halves;
}

bool regular(const HalfPeriods& halves, double tolerance) {
    return std::all_of(std::begin(halves.of), std::end(halves.of), [&](const std::vector<double>& half) {
        return half.empty() || deviation(half) <= tolerance * mean(half);
    });
}

/// True if y is nearly the same at all switches up, and at all switches down.
bool switched_by_y(const CleanRecord& r, const TwoLevels& u) {
    constexpr double kTolerance = 0.2;  // of the range of y: hysteresis, noise and late samples
    std::vector<double> seen[2];
    for (std::size_t k = 0; k < u.switch_time.size(); ++k) seen[k % 2].push_back(y_before(r, u.switch_time[k]));
    const auto first = std::lower_bound(r.t.begin(), r.t.end(), u.switch_time.front()) - r.t.begin();
    const double moved = spread({r.y.begin() + first, r.y.end()});
    return std::all_of(std::begin(seen), std::end(seen),
                       [&](const auto& y) { return y.empty() || deviation(y) <= kTolerance * moved; });
}

/// True if y is at rest when u switches: in most half periods (in one of two) its last fifth moves little compared with
/// the whole.
bool rests_before_switches(const CleanRecord& r, const TwoLevels& u) {
    constexpr std::ptrdiff_t kMinHalfPeriod = 5;  // samples: a tenth of a half period needs some
    constexpr double kAtRest = 0.03;              // of the movement of y in the half period
    int resting = 0, halves = 0;
    for (std::size_t k = 1; k < u.switch_time.size(); ++k) {
        const double from = u.switch_time[k - 1], to = u.switch_time[k], tenth = (to - from) / 10;
        const double late = std::abs(y_mean(r, to - tenth, to) - y_mean(r, to - 2 * tenth, to - tenth));
        const auto first = std::lower_bound(r.t.begin(), r.t.end(), from),
                   last = std::upper_bound(first, r.t.end(), to);
        if (last - first < kMinHalfPeriod) continue;
        ++halves;
        if (late < kAtRest * spread({r.y.begin() + (first - r.t.begin()), r.y.begin() + (last - r.t.begin())}))
            ++resting;
    }
    constexpr int kMaxFewHalves = 2;  // half periods: if one of them ends at rest there is no relay
    return halves <= kMaxFewHalves ? resting > 0 : 2 * resting > halves;
}

bool is_relay(const CleanRecord& r, const TwoLevels& u) {
    if (static_cast<int>(u.switch_time.size()) < kMinSwitches) return false;
    const HalfPeriods halves = half_periods(u);
    constexpr std::size_t kTwoPeriods = 5;  // switches
    constexpr double kMaxRegularDeviation = 0.1,
                     kMaxRoughDeviation = 0.5;  // standard deviation of the half periods over their mean
    const bool repeats = u.switch_time.size() >= kTwoPeriods && regular(halves, kMaxRegularDeviation);
    const bool follows_y = regular(halves, kMaxRoughDeviation) && switched_by_y(r, u);
    return (repeats || follows_y) && !rests_before_switches(r, u);
}

/// The border between the two groups of `levels`: the widest gap.
double widest_gap(std::vector<double> levels, double& gap) {
    std::sort(levels.begin(), levels.end());
    gap = 0;
    double border = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
        if (levels[i] - levels[i - 1] <= gap) continue;
        gap = levels[i] - levels[i - 1];
        border = 0.5 * (levels[i] + levels[i - 1]);
    }
    return border;
}

/// The levels [first, last) as two groups; false if there are not two.
bool alternate(const InputLevels& levels, std::size_t first, std::size_t last, TwoLevels& out) {
    constexpr double kMinGapOverSpread = 10;  // gap between the groups over the spread inside them
    const std::vector<double> used(levels.level.begin() + static_cast<std::ptrdiff_t>(first),
                                   levels.level.begin() + static_cast<std::ptrdiff_t>(last));
    double gap = 0;
    const double border = widest_gap(used, gap);
    std::vector<double> group[2];
    for (const double level : used) group[level > border].push_back(level);
    if (group[0].empty() || group[1].empty()) return false;
    if (gap < kMinGapOverSpread * std::max(spread(group[0]), spread(group[1]))) return false;
    out = {mean(group[0]), mean(group[1]), {}, used.front() < border};
    for (std::size_t i = first + 1; i < last; ++i) {
        if ((levels.level[i] > border) != (levels.level[i - 1] > border)) out.switch_time.push_back(levels.time[i]);
    }
    return true;
}

/// True if u returns to its first level, like a relay that works from the first row.
bool comes_back(const CleanRecord& r) {
    return r.changes() > 1 && std::any_of(r.v_level.begin(), r.v_level.end(), [](double v) { return v == 0; });
}

}  // namespace

InputLevels input_levels(const CleanRecord& r) {
    constexpr double kMaxJitter = 0.02, kMaxSlew = 0.01;
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double jitter = kMaxJitter * (std::max(*high, 0.0) - std::min(*low, 0.0));
    const double slew = std::max(kMaxSlew, 2.5 / r.samples());
    InputLevels out{{0}, {0}};
    double last_move = 0;
    for (int j = 0; j < r.changes(); ++j) {
        const double move = r.v_level[j] - out.level.back();
        if (std::abs(move) <= jitter) continue;
        if (last_move * move > 0 && r.v_time[j] - out.time.back() <= slew) {
            out.level.back() = r.v_level[j];
            continue;
        }
        out.time.push_back(r.v_time[j]);
        out.level.push_back(r.v_level[j]);
        last_move = move;
    }
    return out;
}

std::vector<double> move_times(const CleanRecord& record) {
    constexpr int kDigits = 12;  // 50 as the file has it, not 49.99999999999999 as the scaled record gives it back
    const InputLevels levels = input_levels(record);
    std::vector<double> times;
    for (std::size_t j = 1; j < levels.time.size() && times.size() < std::size_t{kMaxSteps}; ++j)
        times.push_back(std::stod(text(record.scale.t_origin + record.scale.t_scale * levels.time[j], kDigits)));
    return times;
}

TwoLevels two_levels(const InputLevels& levels) {
    TwoLevels best;
    const std::size_t n = levels.level.size();
    // The whole record, or without the level before the test, without that after it, without both.
    for (const std::size_t before : {0u, 1u}) {
        for (const std::size_t after : {0u, 1u}) {
            if (n < before + after + 2) continue;
            TwoLevels now;
            if (alternate(levels, before, n - after, now) && now.switch_time.size() > best.switch_time.size())
                best = std::move(now);
        }
    }
    return best;
}

RecordKind found_kind(const CleanRecord& record) {
    const InputLevels levels = input_levels(record);
    if (levels.moves() <= 1) return RecordKind::step;
    if (is_relay(record, two_levels(levels))) return RecordKind::relay;
    return levels.moves() < kMaxSteps ? RecordKind::several_steps : RecordKind::general;
}

const char* name_of(RecordKind kind) {
    switch (kind) {
        case RecordKind::automatic: break;
        case RecordKind::step: return "step";
        case RecordKind::several_steps: return "several_steps";
        case RecordKind::relay: return "relay";
        case RecordKind::general: return "general";
    }
    return "auto";
}

bool moves_at_first(std::span<const double> t, std::span<const double> values) {
    constexpr double kSlopeStandardErrors = 5;  // standard errors of the slope
    constexpr double kMinVisibleShare = 0.03;   // of the range, over these rows
    constexpr double kMinScatterRatio = 4;      // multiple of the scatter around the line
    constexpr double kMinShareInTheEnd = 0.05;  // of the range, over the whole record
    const Line line = straight_line(t, values);
    const double slope = std::abs(line.slope), moved = slope * (t.back() - t.front());
    if (slope <= kSlopeStandardErrors * line.slope_std) return false;
    const std::vector<double> left = residuals(line, t, values);
    if (moved > kMinVisibleShare && moved > kMinScatterRatio * deviation(left)) return true;
    return slope > kSlopeStandardErrors * line.slope_std * std::sqrt(correlation_time(left)) &&
           slope > kMinShareInTheEnd;
}

RecordStart start_of(const CleanRecord& r, bool relay, double noise) {
    if (r.moved_at_first_row) return RecordStart::moving;
    if (r.u0_given) return RecordStart::at_rest;
    const auto n = static_cast<std::size_t>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin());
    if (n < kRestRows || r.t[n - 1] <= r.t[0])
        return input_levels(r).moves() == 1 ? RecordStart::at_rest : RecordStart::unseen;
    const std::span t(r.t.data(), n), y(r.y.data(), n);
    if (relay && comes_back(r)) {
        constexpr double kMaxStillRange = 0.01, kTimesNoise = 6;  // of y's range; range of about a hundred readings, in
                                                                  // standard deviations
        const auto [low, high] = std::minmax_element(y.begin(), y.end());
        return *high - *low <= std::max(kMaxStillRange, kTimesNoise * noise) ? RecordStart::at_rest
                                                                             : RecordStart::unseen;
    }
    return moves_at_first(t, y) ? RecordStart::moving : RecordStart::at_rest;
}

}  // namespace tunewright
