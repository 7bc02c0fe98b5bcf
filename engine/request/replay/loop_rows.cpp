#include "engine/request/replay/loop_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

}  // namespace

Expected<LoopRows> loop_rows(const Record& record) {
    const auto set_point = set_point_changes(record);
    if (set_point.empty()) return Error{ErrorKind::invalid_argument, "record/r", "The record has no set point."};
    const auto clean = clean_record(record);
    if (!clean) return clean.error();
    const RecordScale& scale = clean->scale;
    const double duration = clean->t.back(), usual = usual_spacing(*clean);
    const int rows = static_cast<int>(std::min<double>(kMaxReplayRows, std::floor(duration / usual + 1.5)));
    const double step = rows < kMaxReplayRows ? usual : duration / (kMaxReplayRows - 1);
    LoopRows made{.t0 = scale.t_origin, .h = step * scale.t_scale, .u = {}, .y = {}, .r = {}};
    constexpr double kSlack = 1e-6;  // of a row: nearer times are equal
    LastBefore sample, move, wanted;
    for (int k = 0; k < rows; ++k) {
        const double t = std::min(k * step, duration), now = t + kSlack * step;
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
    return made;
}

}  // namespace tunewright
