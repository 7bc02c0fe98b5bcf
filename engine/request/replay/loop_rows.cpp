#include "engine/request/replay/loop_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/closed_loop/outside_excitation.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {
namespace {

using Index = std::size_t;

std::vector<std::pair<double, double>> set_point_changes(const Record& record) {
    std::vector<std::pair<double, double>> known;
    for (Index i = 0; i < std::min(record.t.size(), record.r.size()); ++i)
        if (std::isfinite(record.t[i]) && std::isfinite(record.r[i])) known.emplace_back(record.t[i], record.r[i]);
    std::ranges::stable_sort(known, {}, &std::pair<double, double>::first);
    return known;
}

// The index of the last of the ascending times that is not after t; 0 before the first.
class LastBefore {
public:
    template <class Time>
    Index at(double t, Index size, const Time& time) {
        while (i_ + 1 < size && time(i_ + 1) <= t) ++i_;
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

}  // namespace

Expected<RecordedLoop> recorded_loop(const Record& record) {
    const auto set_point = set_point_changes(record);
    if (set_point.empty()) return Error{ErrorKind::invalid_argument, "record/r", "The record has no set point."};
    const auto clean = clean_record(record);
    if (!clean) return clean.error();
    const SetPoint r = set_point_of(*clean, record);
    if (r.at_samples.empty())
        return Error{ErrorKind::invalid_argument, "record/r", "Column r is no set point: it follows y or commands u."};
    const RecordScale& scale = clean->scale;
    const double duration = clean->t.back(), step = usual_spacing(*clean);
    const double all = std::floor(duration / step + 1.5);
    const int rows = static_cast<int>(std::min<double>(kMaxReplayRows, all));
    const double start = all > rows ? duration - step * (rows - 1) : 0;
    LoopRows made{.t0 = scale.t_origin + scale.t_scale * start, .h = step * scale.t_scale, .u = {}, .y = {}, .r = {}};
    constexpr double kSlack = 1e-6;  // of a row: nearer times are equal
    LastBefore sample, move, wanted;
    for (int k = 0; k < rows; ++k) {
        const double t = std::min(start + k * step, duration), now = t + kSlack * step;
        const Index i = sample.at(now, clean->t.size(), [&](Index j) { return clean->t[j]; });
        double y = clean->y[i];
        if (i + 1 < clean->t.size() && t > clean->t[i])
            y += (clean->y[i + 1] - y) * (t - clean->t[i]) / (clean->t[i + 1] - clean->t[i]);
        made.y.push_back(scale.y_origin + scale.y_scale * y);
        const Index j = move.at(now, clean->v_time.size(), [&](Index n) { return clean->v_time[n]; });
        const bool moved = !clean->v_time.empty() && clean->v_time[j] <= now;
        made.u.push_back(scale.u_rest + (moved ? scale.u_scale * clean->v_level[j] : 0));
        const double at = scale.t_origin + scale.t_scale * now;
        made.r.push_back(
            set_point[wanted.at(at, set_point.size(), [&](Index n) { return set_point[n].first; })].second);
    }
    RecordedLoop loop{.rows = std::move(made)};
    loop.manual = switched_on(*clean, r.at_samples) || manual_stretch(*clean) || held_against_error(loop.rows);
    return loop;
}

}  // namespace tunewright
