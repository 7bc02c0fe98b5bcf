#include "engine/identification/fit/gap_moves.h"

#include <algorithm>
#include <iterator>

namespace tunewright {
namespace {

/// The time of the last row before the one at or after `time`.
double row_before(const CleanRecord& r, double time) {
    constexpr double kRounding = 1e-12;  // of the record's length
    const auto row = std::lower_bound(r.t.begin(), r.t.end(), time - kRounding);
    return row == r.t.begin() ? time : *std::prev(row);
}

}  // namespace

std::vector<int> gap_moves(const CleanRecord& record) {
    constexpr double kLong = 1.5;
    const double usual = usual_spacing(record);
    std::vector<int> moves;
    for (int j = 0; j < record.changes(); ++j) {
        if (record.v_time[j] - row_before(record, record.v_time[j]) > kLong * usual) moves.push_back(j);
    }
    return moves;
}

CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  const std::stop_token& stop) {
    constexpr int kRounds = 3, kFarthest = 8;  // rows back
    const double usual = usual_spacing(record);
    CleanRecord placed = record;
    placed.moves_placed = static_cast<int>(moves.size());
    const auto misses = [&] { return project({&placed, {}}, fit.form, fit.shape).sse; };
    double least = misses();
    for (int round = 0; round < kRounds; ++round) {
        bool moved = false;
        for (const int j : moves) {
            if (stop.stop_requested()) return placed;
            const double seen = record.v_time[j];
            const double first = std::max(row_before(record, seen), j > 0 ? placed.v_time[j - 1] : 0.0);
            double best = placed.v_time[j];
            for (int back = 0; back <= kFarthest && seen - back * usual > first + 0.5 * usual; ++back) {
                placed.v_time[j] = seen - back * usual;
                const double now = misses();
                if (now < least) {
                    least = now;
                    best = placed.v_time[j];
                    moved = true;
                }
            }
            placed.v_time[j] = best;
        }
        if (!moved) break;
    }
    return placed;
}

}  // namespace tunewright
