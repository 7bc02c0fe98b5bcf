#include "engine/request/replay/loop_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kSlack = 1e-6;  // of a row: nearer times are equal

// The index of the last of the ascending times that is not after t; 0 before the first.
class LastBefore {
public:
    Index at(double t, const std::vector<double>& times) {
        while (i_ + 1 < times.size() && times[i_ + 1] <= t) ++i_;
        return i_;
    }

private:
    Index i_ = 0;
};

/// True if u stands still, away from its ends, over rows that hold a tenth of the error and more: with an integral it
/// would move.
bool held_against_error(const LoopRows& rows) {
    constexpr Index kMinHeldRows = 30;
    constexpr double kMaxHeldShare = 0.1;
    const auto [low, high] = std::ranges::minmax(rows.u);
    double all = 0, held = 0;
    for (Index from = 0, to = 0; from < rows.size(); from = to) {
        double error = 0;
        for (; to < rows.size() && rows.u[to] == rows.u[from]; ++to) error += std::abs(rows.r[to] - rows.y[to]);
        all += error;
        if (to - from >= kMinHeldRows && rows.u[from] > low && rows.u[from] < high) held += error;
    }
    return held > kMaxHeldShare * all;
}

/// All rows, of a long record the last ones.
LoopRows even_rows(const IdentifiedLoop& loop) {
    const CleanRecord& clean = loop.clean;
    const RecordScale& scale = clean.scale;
    const double duration = clean.t.back(), step = usual_spacing(clean);
    const double all = std::floor(duration / step + 1.5);
    const int rows = static_cast<int>(std::min<double>(kMaxReplayRows, all));
    const double start = all > rows ? duration - step * (rows - 1) : 0;
    LoopRows made{.t0 = scale.t_origin + scale.t_scale * start, .h = step * scale.t_scale, .u = {}, .y = {}, .r = {}};
    LastBefore sample, move, wanted;
    for (int k = 0; k < rows; ++k) {
        const double t = std::min(start + k * step, duration), now = t + kSlack * step;
        const Index i = sample.at(now, clean.t);
        double y = clean.y[i];
        if (i + 1 < clean.t.size() && t > clean.t[i])
            y += (clean.y[i + 1] - y) * (t - clean.t[i]) / (clean.t[i + 1] - clean.t[i]);
        made.y.push_back(scale.y_origin + scale.y_scale * y);
        const Index j = move.at(now, clean.v_time);
        const bool moved = !clean.v_time.empty() && clean.v_time[j] <= now;
        made.u.push_back(scale.u_rest + (moved ? scale.u_scale * clean.v_level[j] : 0));
        const double at = scale.t_origin + scale.t_scale * now;
        made.r.push_back(loop.set_point.value[wanted.at(at, loop.set_point.time)]);
    }
    return made;
}

/// The longest stretch of rows in automatic.
LoopRows in_automatic(const LoopRows& rows, const HeldColumn& automatic) {
    LastBefore mode;
    Index from = 0, longest = 0, first = 0;
    for (Index k = 0; k < rows.size(); ++k) {
        const double t = rows.t0 + rows.h * (static_cast<double>(k) + kSlack);
        if (automatic.value[mode.at(t, automatic.time)] == 0)
            from = k + 1;
        else if (k + 1 - from > longest)
            longest = k + 1 - from, first = from;
    }
    const auto cut = [&](const std::vector<double>& column) {
        const auto begin = column.begin() + static_cast<std::ptrdiff_t>(first);
        return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(longest));
    };
    return {.t0 = rows.t0 + rows.h * static_cast<double>(first),
            .h = rows.h,
            .u = cut(rows.u),
            .y = cut(rows.y),
            .r = cut(rows.r)};
}

}  // namespace

std::optional<LoopRows> rows_in_automatic(const IdentifiedLoop& loop) {
    LoopRows rows = even_rows(loop);
    if (loop.automatic.empty()) {
        if (loop.switched_on || manual_stretch(loop.clean) || held_against_error(rows)) return std::nullopt;
        return rows;
    }
    rows = in_automatic(rows, loop.automatic);
    return rows.size() < kMinReplayRows ? std::nullopt : std::optional(std::move(rows));
}

}  // namespace tunewright
