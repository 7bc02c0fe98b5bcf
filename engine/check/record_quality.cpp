#include "engine/check/record_quality.h"

#include <algorithm>
#include <cmath>

#include "engine/check/thresholds.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"

namespace tunewright::check {
namespace {

constexpr double kOnLine = 1e-6;  // of the neighbours' difference: rounding of a historian's interpolation

/// The share of rows that lie on the straight line through both neighbours, which differ.
double straight_share(std::span<const double> y) {
    std::size_t straight = 0, moving = 0;
    for (std::size_t i = 1; i + 1 < y.size(); ++i) {
        const double across = y[i + 1] - y[i - 1];
        if (across == 0) continue;
        ++moving;
        straight += std::abs(y[i] - 0.5 * (y[i + 1] + y[i - 1])) <= kOnLine * std::abs(across) ? 1 : 0;
    }
    return moving > 0 ? static_cast<double>(straight) / static_cast<double>(moving) : 0;
}

double held_share(std::span<const double> y) {
    std::size_t held = 0;
    for (std::size_t i = 1; i < y.size(); ++i) held += y[i] == y[i - 1] ? 1 : 0;
    return y.size() > 1 ? static_cast<double>(held) / static_cast<double>(y.size() - 1) : 0;
}

std::size_t levels(std::span<const double> y) {
    std::vector<double> values(y.begin(), y.end());
    std::ranges::sort(values);
    return values.size() - std::ranges::unique(values).size();
}

double longest_gap(const Rows& rows) {
    double longest = 0, last = NAN;
    for (std::size_t i = 0; i < rows.t.size(); ++i) {
        if (!rows.measured[i]) continue;
        if (std::isfinite(last)) longest = std::max(longest, rows.t[i] - last);
        last = rows.t[i];
    }
    return longest;
}

Figure measurement_at_limit(std::span<const double> y, const std::optional<std::array<double, 2>>& range) {
    if (!range) return no_figure("The range of the measurement is not given.");
    if (y.empty()) return no_figure("The record has no measurement.");
    const auto [low, high] = *range;
    const double near = kAtLimit * (high - low);
    const auto at = std::ranges::count_if(y, [&](double value) { return value <= low + near || value >= high - near; });
    return static_cast<double>(at) / static_cast<double>(y.size());
}

std::string percent(double share) { return text(std::round(100 * share)) + " %"; }

void remark(RecordQuality& q, const char* code, std::string detail, bool fatal) {
    q.remarks.push_back({code, std::move(detail), fatal ? WarningLevel::bad : WarningLevel::warning});
    if (fatal) q.enough = false;
}

void judge(RecordQuality& q, const Samples& samples) {
    if (q.missing > kMostMissing)
        remark(q, "measurement-missing",
               percent(q.missing) + " of the rows have no measurement. Export the raw values, or another day.", true);
    if (q.at_limit.value_or(0) >= kSaturatedShare)
        remark(q, kMeasurementAtLimit,
               "The measurement is at an end of its range for " + percent(*q.at_limit) +
                   " of the time, where it does not show the process: no cause is concluded.",
               true);
    if (samples.size() < kFewestRows)
        remark(q, "short-record",
               "The record has " + std::to_string(samples.size()) + " usable rows; a check needs at least " +
                   std::to_string(kFewestRows) + ". Record for longer, or with shorter steps.",
               true);
    else if (samples.duration() < kLeastPart * q.duration)
        remark(q, "many-gaps",
               "The longest part without a gap is " + percent(samples.duration() / q.duration) +
                   " of the record; only this part is judged.",
               false);
    if (q.compressed)
        remark(
            q, "compressed",
            "The measurement was compressed by the historian: between stored values it is a straight line or a stair. "
            "Export raw values: noise, valve and oscillation are distorted.",
            false);
}

}  // namespace

RecordQuality quality_of(const Rows& rows, const Samples& samples,
                         const std::optional<std::array<double, 2>>& y_range) {
    RecordQuality q;
    q.rows = static_cast<int>(rows.t.size());
    q.sample_time = rows.step;
    q.duration = rows.t.empty() ? 0 : rows.t.back() - rows.t.front();
    if (!rows.measured.empty())
        q.missing = static_cast<double>(std::ranges::count(rows.measured, 0)) / static_cast<double>(rows.t.size());
    q.longest_gap = longest_gap(rows);
    if (!samples.y.empty()) {
        q.held = held_share(samples.y);
        q.noise = noise_std(samples.y);
        q.y_step = quantisation_step(samples.y);
        q.u_step = quantisation_step(samples.u);
        const bool stairs = q.held > kStairs && levels(samples.y) > kFewLevels;
        q.compressed = stairs || straight_share(samples.y) > kStraight;
    }
    q.at_limit = measurement_at_limit(samples.y, y_range);
    judge(q, samples);
    return q;
}

}  // namespace tunewright::check
