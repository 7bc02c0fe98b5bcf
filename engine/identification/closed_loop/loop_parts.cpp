#include "engine/identification/closed_loop/loop_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/record/record_kind.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr int kMinRowsBetweenMoves = 10;  ///< rows between two manual moves

/// Rows [from, to), and the changes of u [first, last) inside that may be manual.
struct QuietStretch {
    int from = 0, to = 0, first = 0, last = 0;
};

/// The first row that shows a change of u.
int first_row_of(const CleanRecord& record, int change) {
    const double time = record.v_time[static_cast<std::size_t>(change)];
    return static_cast<int>(std::ranges::lower_bound(record.t, time) - record.t.begin());
}

/// Intervals between changes of u that are too close together.
std::vector<QuietStretch> quiet_runs(const CleanRecord& r) {
    std::vector<int> row;
    for (int change = 0; change < r.changes(); ++change) row.push_back(first_row_of(r, change));
    std::vector<QuietStretch> runs;
    const auto near = [&](int j) { return j > 0 && row[j] - row[j - 1] < kMinRowsBetweenMoves; };
    for (int j = 0; j <= r.changes(); ++j) {
        const bool ends = j == r.changes() || (j + 1 < r.changes() && near(j + 1));
        if (runs.empty()) runs.push_back({});
        QuietStretch& now = runs.back();
        if (j < r.changes() && near(j)) {
            now = {row[j], 0, j + 1, 0};  // the controller's last move: u may be constant after it
            continue;
        }
        if (!ends) continue;
        now.to = j < r.changes() ? row[j] : r.samples();
        now.last = j;
        runs.push_back({});
    }
    return runs;
}

bool steps_inside(const CleanRecord& r, const QuietStretch& run) {
    constexpr double kMinMoveShare = 0.05;  // of u's range
    constexpr int kMinRowsAfterMove = 15;   // rows
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double range = std::max(*high, 0.0) - std::min(*low, 0.0);
    for (int j = run.first; j < run.last; ++j) {
        const auto row = std::lower_bound(r.t.begin(), r.t.end(), r.v_time[j]) - r.t.begin();
        const double move = r.v_level[j] - (j > 0 ? r.v_level[j - 1] : 0);
        if (std::abs(move) > kMinMoveShare * range && run.to - row > kMinRowsAfterMove) return true;
    }
    return false;
}

/// of an interval's length: rounding of times that were scaled and scaled back
constexpr double kStretchTolerance = 1e-9;

Record between(const Record& record, double from, double to) {
    Record part;
    part.kind = record.kind;
    part.u_limits = record.u_limits;
    for (const FurtherInput& input : record.d) part.d.push_back({input.name, {}});
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        if (!(record.t[i] >= from && record.t[i] <= to)) continue;
        part.t.push_back(record.t[i]);
        part.u.push_back(record.u[i]);
        part.y.push_back(record.y[i]);
        for (std::size_t k = 0; k < part.d.size(); ++k) part.d[k].values.push_back(record.d[k].values[i]);
        if (!record.line.empty()) part.line.push_back(record.line[i]);
    }
    return part;
}

bool has_feedback(const Record& record) {
    const Expected<CleanRecord> clean = clean_record(record);
    return clean && find_feedback(*clean).has_value();
}

}  // namespace

std::optional<double> level_before_set_point(const CleanRecord& record, const std::vector<double>& r) {
    const auto moved = std::ranges::find_if(r, [&](double value) { return value != r.front(); });
    const auto n = static_cast<std::size_t>(moved - r.begin());
    if (moved == r.end() || n < kRestRows || record.t[n - 1] <= record.t[0]) return std::nullopt;
    std::vector<double> u = input_at_samples(record);
    u.resize(n);
    const std::span t(record.t.data(), n), y(record.y.data(), n);
    if (moves_at_first(t, y) || moves_at_first(t, u)) return std::nullopt;
    return record.scale.u_rest + record.scale.u_scale * mean(u);
}

namespace {

/// True if u steps once in `run`, to an end of its range in the record, and leaves it while y is on its way: a
/// controller that is switched on far from its set point does that; an operator waits for y to come to rest.
bool one_step_to_end(const CleanRecord& record, const QuietStretch& run) {
    constexpr double kLastPartShare = 0.25,
                     kMaxStillMovement = 0.1;  // of the rows after the step; of y's movement over all of them
    if (run.last - run.first != 1) return false;
    const auto [low, high] = std::ranges::minmax(record.v_level);
    const double level = record.v_level[static_cast<std::size_t>(run.first)];
    if (level != low && level != high) return false;
    const int from = first_row_of(record, run.first),
              late = run.to - static_cast<int>(kLastPartShare * (run.to - from));
    const auto y = [&](int row) { return record.y[static_cast<std::size_t>(row)]; };
    return late < run.to &&
           std::abs(y(run.to - 1) - y(late - 1)) > kMaxStillMovement * std::abs(y(run.to - 1) - y(from));
}

}  // namespace

std::optional<SwitchOn> switched_on(const CleanRecord& record, const std::vector<double>& r) {
    constexpr double kMinSetPointDistance = 0.05;       // of y's range
    constexpr int kRowsBefore = 10, kMaxRowOffset = 2;  // rows
    constexpr double kNoiseMargin = 0.5;                // because noise exceeds the range that ten rows show
    const std::vector<QuietStretch> runs = quiet_runs(record);
    if (runs.size() < 2 || runs.front().from != 0 || runs.front().to >= record.samples()) return std::nullopt;
    const bool held = one_step_to_end(record, runs.front());
    if (runs.front().last > runs.front().first && !held) return std::nullopt;  // a manual test is handled separately
    const int row = held ? first_row_of(record, runs.front().first) : runs.front().to;
    if (row < kRestRows) return std::nullopt;
    const int from = std::max(0, row - kRowsBefore);
    const std::span<const double> y(record.y);
    const auto just_before = y.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(row - from));
    const auto [low, high] = std::ranges::minmax(just_before);
    const double wider = kNoiseMargin * (high - low), now = y[static_cast<std::size_t>(row)];
    if (now < low - wider || now > high + wider) return std::nullopt;
    const SwitchOn on{row, mean(just_before)};
    if (r.empty()) return on;
    for (int i = std::max(1, row - kMaxRowOffset); i <= std::min(row + kMaxRowOffset, record.samples() - 1); ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (r[at] != r[at - 1] && r[at - 1] == r[static_cast<std::size_t>(from)]) return std::nullopt;
    }
    if (std::abs(r[static_cast<std::size_t>(row)] - on.y_before) < kMinSetPointDistance) return std::nullopt;
    return on;
}

std::optional<Stretch> manual_stretch(const CleanRecord& r) {
    constexpr int kMinRows = 30;  // rows
    std::optional<QuietStretch> longest;
    for (const QuietStretch& run : quiet_runs(r)) {
        const bool part = run.to - run.from < r.samples();
        if (!part || run.to - run.from < kMinRows || !steps_inside(r, run)) continue;
        if (!longest || run.to - run.from > longest->to - longest->from) longest = run;
    }
    if (!longest) return std::nullopt;
    const auto time = [&](int row) { return r.scale.t_origin + r.scale.t_scale * r.t[static_cast<std::size_t>(row)]; };
    return Stretch{time(longest->from), time(longest->to - 1), longest->from == 0, one_step_to_end(r, *longest)};
}

Record rows_of(const Record& record, const Stretch& stretch) {
    const double margin = kStretchTolerance * (stretch.to - stretch.from);
    Record part = between(record, stretch.from - margin, stretch.to + margin);
    if (stretch.whole_start) part.u0 = record.u0, part.y0 = record.y0;
    return part;
}

bool feedback_outside(const Record& record, const Stretch& stretch) {
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    const double margin = kStretchTolerance * (stretch.to - stretch.from);
    return has_feedback(between(record, -kUnbounded, stretch.from - margin)) ||
           has_feedback(between(record, stretch.to + margin, kUnbounded));
}

}  // namespace tunewright
