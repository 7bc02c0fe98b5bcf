#include "engine/identification/search/record_repair.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "engine/identification/further_inputs/further_inputs.h"
#include "engine/identification/record/series.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr std::size_t kMaxRun = 3;
constexpr double kMinShareOfRange = 0.05;

/// The size of a typical value of the series: its median magnitude, converted to a standard deviation.
double usual_size(const std::vector<double>& values) {
    std::vector<double> sizes;
    sizes.reserve(values.size());
    for (const double value : values) sizes.push_back(std::abs(value));
    return sizes.empty() ? 0 : median(std::move(sizes)) / kMedianOfNormal;
}

std::vector<bool> lone_misses(const Fit& fit) {
    constexpr double kMinUsualSizes = 10, kNeighbours = 0.4;
    const std::vector<double>& e = fit.residual;
    const double min = std::max(kMinShareOfRange, kMinUsualSizes * usual_size(e));
    std::vector<bool> lone(e.size(), false);
    for (std::size_t i = 0; i < e.size(); ++i) {
        if (std::abs(e[i]) < min) continue;
        std::size_t end = i + 1;
        while (end < e.size() && std::abs(e[end]) >= min) ++end;
        const double limit = kNeighbours * std::abs(e[i]);
        const bool alone = (i == 0 || std::abs(e[i - 1]) < limit) && (end == e.size() || std::abs(e[end]) < limit);
        if (alone && end - i <= 2)
            std::fill(lone.begin() + static_cast<std::ptrdiff_t>(i), lone.begin() + static_cast<std::ptrdiff_t>(end),
                      true);
        i = end - 1;
    }
    return lone;
}

/// Marks runs to which y jumps and from which it jumps back, by much more than it moves otherwise from sample to
/// sample.
void mark_jumps(const std::vector<double>& y, std::vector<bool>& marked) {
    constexpr double kMinShareOfRangeAtOnce = 0.25, kMinUsualSizes = 10;
    std::vector<double> moves;
    for (std::size_t i = 1; i < y.size(); ++i) moves.push_back(y[i] - y[i - 1]);
    const double min = std::max(kMinShareOfRangeAtOnce, kMinUsualSizes * usual_size(moves));
    for (std::size_t i = 0; i < moves.size(); ++i) {
        if (std::abs(moves[i]) < min) continue;
        for (std::size_t k = i + 1; k < moves.size() && k <= i + kMaxRun; ++k) {
            if (moves[k] * moves[i] >= 0 || std::abs(moves[k]) < min) continue;
            std::fill(marked.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                      marked.begin() + static_cast<std::ptrdiff_t>(k) + 1, true);
            break;
        }
    }
}

/// The least distance of the model from the samples to which it was not fitted; their indices are those of the whole
/// record.
double min_miss(const CleanRecord& whole, const std::vector<std::size_t>& left_out, const ModelSearch& found) {
    const Fit there = project(found.context.all(), found.chosen().form, found.chosen().shape);
    UnitResponse response, level;
    static constexpr double kAtOnce[] = {0}, kUnit[] = {1};
    std::vector<double> times;
    times.reserve(left_out.size());
    for (const std::size_t i : left_out) times.push_back(whole.t[i]);
    const ModelForm& form = there.form;
    const int derivatives = form.gains() - 1;
    const CleanRecord& input = found.context.record;  // as the model sees it: placed moves, or behind a play
    unit_response(times, {input.v_time, input.v_level}, there.shape, derivatives, response);
    unit_response(times, {kAtOnce, kUnit}, there.shape, derivatives, level);
    CleanRecord unseen{found.context.record, times, {}, {}, {}, {}, {}, found.context.record.d};
    std::vector<std::vector<double>> further;
    for (int j = 0; j < form.further; ++j) further.push_back(further_part(unseen, there, j));
    double min = HUGE_VAL;
    for (std::size_t k = 0; k < times.size(); ++k) {
        double y = there.linear[static_cast<std::size_t>(form.offset_index())];
        const auto add = [&](int index, const UnitResponse& x) {
            y += there.linear[static_cast<std::size_t>(index)] * x.x[k];
            if (form.gains() == 2) y += there.linear[static_cast<std::size_t>(index) + 1] * x.x1[k];
        };
        add(0, response);
        if (form.other_level) add(form.level_index(), level);
        if (form.slope) y += there.linear[static_cast<std::size_t>(form.slope_index())] * times[k];
        for (const std::vector<double>& part : further) y += part[k];
        min = std::min(min, std::abs(whole.y[left_out[k]] - y));
    }
    return min;
}

/// True if the rows up to the one at `time` have the usual spacing, as with a recorder that always writes. A recorder
/// that waits for a change writes few rows at rest.
bool written_steadily(const CleanRecord& r, double time, double usual) {
    constexpr std::ptrdiff_t kLastRows = 8, kMaxLateRows = 2;  // number of checked rows, and of late ones among them
    constexpr double kMinLateSpacings = 1.5;                   // usual spacings
    const auto last = std::lower_bound(r.t.begin(), r.t.end(), time) - r.t.begin();
    if (last < kLastRows) return false;
    std::ptrdiff_t late = 0;
    for (auto i = last - kLastRows + 1; i <= last; ++i)
        late +=
            r.t[static_cast<std::size_t>(i)] - r.t[static_cast<std::size_t>(i) - 1] > kMinLateSpacings * usual ? 1 : 0;
    return late <= kMaxLateRows;
}

/// Moves each of the changes `moves` of `placed` to the time at which structure and shape of `fit` explain y best, one
/// after the other until none moves. `offer(j, take)` calls take(time) for each possible time of change j; take returns
/// whether that is the best so far.
template <class Offer>
void place(CleanRecord& placed, const Fit& fit, const std::vector<int>& moves, const std::stop_token& stop,
           const Offer& offer) {
    constexpr int kRounds = 3;
    double min = project({&placed, {}}, fit.form, fit.shape).sse;
    for (int round = 0; round < kRounds; ++round) {
        bool moved = false;
        for (const int j : moves) {
            if (stop.stop_requested()) return;
            double best = placed.v_time[j];
            offer(j, [&](double time) {
                placed.v_time[j] = time;
                const double now = project({&placed, {}}, fit.form, fit.shape).sse;
                if (!(now < min)) return false;
                min = now;
                best = time;
                return moved = true;
            });
            placed.v_time[j] = best;
        }
        if (!moved) return;
    }
}

}  // namespace

double row_before(const CleanRecord& r, double time) {
    constexpr double kTimeTolerance = 1e-12;  // of the record's length
    const auto row = std::lower_bound(r.t.begin(), r.t.end(), time - kTimeTolerance);
    return row == r.t.begin() ? time : *std::prev(row);
}

std::vector<std::size_t> doubtful_samples(const CleanRecord& record, const Fit& fit) {
    std::vector<bool> marked = lone_misses(fit);
    mark_jumps(record.y, marked);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        if (marked[i]) found.push_back(i);
    }
    const std::size_t max = std::max<std::size_t>(4, marked.size() / 100);
    return found.size() <= max ? found : std::vector<std::size_t>{};
}

ModelSearch without_false_readings(ModelSearch search, CleanRecord& record, ModelChoice model,
                                   const RunControl& control) {
    constexpr double kTimesOthers = 8;
    if (search.context.record.samples() != record.samples() || search.part < 1) return search;
    const std::vector<std::size_t> doubtful = doubtful_samples(record, search.chosen());
    if (doubtful.empty()) return search;
    CleanRecord rest = without_samples(record, doubtful);
    ModelSearch again = search_with_further(rest, model, search.context.relay, control);
    if (again.choice.index < 0 || control.stop.stop_requested()) return search;
    const Fit& fit = again.chosen();
    const double rms = std::sqrt(fit.sse / static_cast<double>(fit.residual.size()));
    if (min_miss(record, doubtful, again) < std::max(kMinShareOfRange, kTimesOthers * rms)) return search;
    record = std::move(rest);
    return again;
}

std::vector<int> gap_moves(const CleanRecord& record) {
    constexpr double kMinLongSpacings = 1.5;  // in usual spacings: a row is missing
    const double usual = usual_spacing(record);
    std::vector<int> moves;
    for (int j = 0; j < record.changes(); ++j) {
        if (record.v_time[j] - row_before(record, record.v_time[j]) > kMinLongSpacings * usual) moves.push_back(j);
    }
    return moves;
}

std::optional<CleanRecord> with_unseen_moves(const CleanRecord& record) {
    constexpr double kMinUnseenSpacings = 2;  // usual spacings
    if (static_cast<int>(gap_moves(record).size()) < record.changes() || unevenly_spaced(record)) return std::nullopt;
    const double usual = usual_spacing(record);
    const auto written = [&](double time) { return written_steadily(record, row_before(record, time), usual); };
    if (!std::ranges::all_of(record.v_time, written)) return std::nullopt;
    CleanRecord middle = record;
    middle.moves_unseen = 1;
    for (double& time : middle.v_time) {
        const double hidden = time - row_before(record, time) - usual;
        middle.moves_unseen = std::min(middle.moves_unseen, hidden);
        time -= 0.5 * hidden;
    }
    if (middle.moves_unseen < kMinUnseenSpacings * usual) return std::nullopt;
    return middle;
}

CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  const std::stop_token& stop) {
    constexpr int kMaxRowsBack = 8;  // rows back
    const double usual = usual_spacing(record);
    CleanRecord placed = record;
    placed.moves_placed = static_cast<int>(moves.size());
    placed.moves_unseen = 0;
    place(placed, fit, moves, stop, [&](int j, const auto& take) {
        const double seen = record.v_time[j];
        const double first = std::max(row_before(record, seen), j > 0 ? placed.v_time[j - 1] : 0.0);
        for (int back = 0; back <= kMaxRowsBack && seen - back * usual > first + 0.5 * usual; ++back)
            take(seen - back * usual);
    });
    return placed;
}

CleanRecord with_switches_placed(const CleanRecord& record, const Fit& fit, const std::stop_token& stop) {
    constexpr int kParts = 5;  // parts of a row, and then of such a part
    std::vector<int> all(static_cast<std::size_t>(record.changes()));
    std::iota(all.begin(), all.end(), 0);
    CleanRecord placed = record;
    placed.switches_placed = record.changes();
    place(placed, fit, all, stop, [&](int j, const auto& take) {
        const double seen = record.v_time[j], row = row_before(record, seen), part = (seen - row) / kParts;
        const double first = std::max(row, j > 0 ? placed.v_time[j - 1] : 0.0);
        double best = placed.v_time[j];
        for (const double step : {part, part / kParts}) {
            const double middle = best;
            for (int k = -kParts + 1; k < kParts; ++k) {
                const double time = middle + k * step;
                if (time > first + 0.1 * part && time <= seen && take(time)) best = time;
            }
        }
    });
    return placed;
}

}  // namespace tunewright
