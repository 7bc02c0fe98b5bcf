#include "engine/identification/record/false_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tunewright {
namespace {

constexpr std::size_t kMinRows = 12;  // fewer samples do not show the usual movement

/// Values that sensors and their amplifiers report instead of a reading; a process may pass through them: DS18B20 not
/// yet read and not connected (in C and in F), an open or shorted thermocouple, no signal.
constexpr double kSensorFaults[] = {85, 185, -127, -196.6, 850, 1820, -999, 999, -999.9, 999.9, 0};

double median_of_five(std::span<const double> y, std::size_t middle) {
    double v[5] = {y[middle - 2], y[middle - 1], y[middle], y[middle + 1], y[middle + 2]};
    std::nth_element(v, v + 2, v + 5);
    return v[2];
}

/// The isolated value; NaN if there is none.
double number_apart(std::span<const double> y) {
    constexpr double kMinRelativeGap = 5;
    double low = y[0], high = y[0];
    for (const double value : y) low = std::min(low, value), high = std::max(high, value);
    double next_low = high, next_high = low;
    std::size_t lows = 0, highs = 0;
    for (const double value : y) {
        if (value > low) next_low = std::min(next_low, value);
        if (value < high) next_high = std::max(next_high, value);
        lows += value == low ? 1 : 0;
        highs += value == high ? 1 : 0;
    }
    const double others_low = high - next_low, others_high = next_high - low;
    if (others_low > 0 && next_low - low > kMinRelativeGap * others_low && 2 * lows < y.size()) return low;
    if (others_high > 0 && high - next_high > kMinRelativeGap * others_high && 2 * highs < y.size()) return high;
    return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> spikes(std::span<const double> y) {
    const std::size_t n = y.size();
    if (n < kMinRows) return {};
    std::vector<double> away(n, 0);
    double low = y[2], high = y[2];
    for (std::size_t i = 2; i + 2 < n; ++i) {
        const double smooth = median_of_five(y, i);
        low = std::min(low, smooth);
        high = std::max(high, smooth);
        away[i] = std::abs(y[i] - smooth);
    }
    constexpr double kUsualQuantile = 0.9, kMinUsualMoves = 10, kMinShareOfRange = 0.25, kMaxReturnShare = 0.3;
    std::vector<double> sorted = away;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(kUsualQuantile * static_cast<double>(n - 1));
    std::nth_element(sorted.begin(), usual, sorted.end());
    const double limit = std::max(kMinUsualMoves * *usual, kMinShareOfRange * (high - low));
    if (high <= low) return {};
    std::vector<std::size_t> found;
    for (std::size_t i = 2; i + 2 < n; ++i) {
        if (away[i] <= limit) continue;
        const std::size_t last = away[i + 1] > limit ? i + 1 : i;
        if (last + 2 >= n || away[last + 1] > limit) {
            while (i + 1 < n && away[i + 1] > limit) ++i;
            continue;
        }
        if (std::abs(y[i - 1] - y[last + 1]) < kMaxReturnShare * away[i]) {
            for (std::size_t k = i; k <= last; ++k) found.push_back(k);
        }
        i = last;
    }
    const std::size_t max = std::max<std::size_t>(3, n / 100);
    return found.size() <= max ? found : std::vector<std::size_t>{};
}

/// True for the samples with isolated values, which are found one after the other.
std::vector<bool> apart(std::span<const double> y) {
    constexpr int kMaxValues = 3;
    std::vector<bool> found(y.size(), false);
    for (int pass = 0; pass < kMaxValues; ++pass) {
        std::vector<double> rest;
        for (std::size_t i = 0; i < y.size(); ++i)
            if (!found[i]) rest.push_back(y[i]);
        const double value = rest.size() < kMinRows ? std::nan("") : number_apart(rest);
        if (std::isnan(value)) break;
        // After the first one, a value that many samples have is a level of y.
        const auto count = static_cast<std::size_t>(std::count(rest.begin(), rest.end(), value));
        if (pass > 0 && count > std::max<std::size_t>(3, rest.size() / 100)) break;
        for (std::size_t i = 0; i < y.size(); ++i) found[i] = found[i] || y[i] == value;
    }
    return found;
}

/// A value that y has exactly in the rows [first, end), but not in their neighbours.
struct HeldRun {
    std::size_t first = 0, end = 0;
    double value = 0;
};

/// Finds the runs that a sensor fault causes.
class FaultRuns {
public:
    FaultRuns(const RecordRows& rows, const std::vector<bool>& known) : rows_(rows), y_(rows.y), known_(known) {
        std::vector<double> moves;
        double last = std::nan("");
        for (std::size_t i = 0; i < y_.size(); ++i) {
            if (known_[i]) continue;
            if (!std::isnan(last) && y_[i] != last) moves.push_back(std::abs(y_[i] - last));
            last = y_[i];
        }
        if (moves.empty()) return;
        constexpr double kUsualQuantile = 0.75;  // of the moves, because rounding makes many of them 0
        const auto usual =
            moves.begin() + static_cast<std::ptrdiff_t>(kUsualQuantile * static_cast<double>(moves.size() - 1));
        std::nth_element(moves.begin(), usual, moves.end());
        usual_move_ = *usual;
    }

    std::vector<HeldRun> find() const {
        constexpr std::size_t kMinSamplesPerFault = 4;  // of the samples: at most a quarter
        std::vector<HeldRun> jumping;
        for (std::size_t i = 1; i < y_.size();) {
            const HeldRun run = run_at(i);
            i = run.end;
            if (!known_[run.first] && jumps(run)) jumping.push_back(run);
        }
        const auto [low, high] = range_without(jumping);
        std::vector<HeldRun> faults;
        std::size_t count = 0;
        for (const HeldRun& run : jumping) {
            if (!is_fault(run, low, high)) continue;
            faults.push_back(run);
            count += run.end - run.first;
        }
        return kMinSamplesPerFault * count > y_.size() ? std::vector<HeldRun>{} : faults;
    }

private:
    HeldRun run_at(std::size_t i) const {
        std::size_t end = i + 1;
        while (end < y_.size() && y_[end] == y_[i]) ++end;
        return {i, end, y_[i]};
    }

    bool jumps(const HeldRun& run) const {
        constexpr double kMinUsualMoves = 10;
        const double limit = kMinUsualMoves * usual_move_;
        const double entry = std::abs(run.value - y_[run.first - 1]);
        if (entry == 0 || entry <= limit || known_[run.first - 1]) return false;
        if (run.end == y_.size()) return !u_moves_before(run.first);
        const double leaving = std::abs(run.value - y_[run.end]);
        constexpr double kMaxReturnShare = 0.3;
        if (leaving <= limit || std::abs(y_[run.end] - y_[run.first - 1]) > kMaxReturnShare * entry) return false;
        return !(u_moves_before(run.first) && u_moves_before(run.end));
    }

    /// True if the row may be a response to a move of u: a process that is faster than the sampling jumps like this.
    bool u_moves_before(std::size_t row) const {
        constexpr std::size_t kRowsAround = 3, kMinRestlessRows = 5;
        if (kMinRestlessRows * rows_.change_time.size() > y_.size()) return false;
        const double from = rows_.t[row > kRowsAround ? row - kRowsAround : 0];
        const auto move = std::lower_bound(rows_.change_time.begin(), rows_.change_time.end(), from);
        return move != rows_.change_time.end() && *move <= rows_.t[row];
    }

    /// The smallest and the largest y outside these runs, which are in ascending order.
    std::pair<double, double> range_without(const std::vector<HeldRun>& runs) const {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        std::size_t next = 0;
        for (std::size_t i = 0; i < y_.size(); ++i) {
            while (next < runs.size() && runs[next].end <= i) ++next;
            if (known_[i] || (next < runs.size() && i >= runs[next].first)) continue;
            low = std::min(low, y_[i]);
            high = std::max(high, y_[i]);
        }
        return {low, high};
    }

    /// `low` and `high`: the range of the readings that do not jump.
    bool is_fault(const HeldRun& run, double low, double high) const {
        constexpr double kMinShareOfRange = 0.1, kMinRangesBeyond = 1, kLongest = 0.1;
        const double range = high - low, entry = std::abs(run.value - y_[run.first - 1]);
        if (!(range > 0)) return false;
        const bool listed = std::ranges::find(kSensorFaults, run.value) != std::end(kSensorFaults);
        const bool outside = run.value < low - kMinShareOfRange * range || run.value > high + kMinShareOfRange * range;
        if (run.end == y_.size() && !outside) return false;
        if (listed && entry > kMinShareOfRange * range && (outside || run.value != 0)) return true;
        const auto length = static_cast<double>(run.end - run.first);
        return (run.value < low - kMinRangesBeyond * range || run.value > high + kMinRangesBeyond * range) &&
               run.end < y_.size() && length <= kLongest * static_cast<double>(y_.size());
    }

    const RecordRows& rows_;
    const std::vector<double>& y_;
    const std::vector<bool>& known_;
    double usual_move_ = 0;
};

/// Marks the spikes among the samples that are not yet marked.
void mark_spikes(std::span<const double> y, std::vector<bool>& found) {
    std::vector<double> rest;
    std::vector<std::size_t> place;
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (found[i]) continue;
        rest.push_back(y[i]);
        place.push_back(i);
    }
    for (const std::size_t i : spikes(rest)) found[place[i]] = true;
}

std::vector<bool> marked(const RecordRows& rows) {
    if (rows.y.size() < kMinRows) return std::vector<bool>(rows.y.size(), false);
    std::vector<bool> found = apart(rows.y);
    for (const HeldRun& run : FaultRuns(rows, found).find())
        std::fill(found.begin() + static_cast<std::ptrdiff_t>(run.first),
                  found.begin() + static_cast<std::ptrdiff_t>(run.end), true);
    mark_spikes(rows.y, found);
    return found;
}

/// Removes the marked samples from index `from` on from the rows, and their marks.
void take_out(RecordRows& rows, std::vector<bool>& found, std::size_t from, Cleaning& cleaning) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows.y.size(); ++i) {
        if (found[i] && i >= from) {
            cleaning.spikes.push_back(rows.number[i]);
            cleaning.spike_times.push_back(rows.t[i]);
            continue;
        }
        rows.t[kept] = rows.t[i];
        rows.y[kept] = rows.y[i];
        rows.number[kept] = rows.number[i];
        found[kept] = found[i];
        ++kept;
    }
    rows.t.resize(kept);
    rows.y.resize(kept);
    rows.number.resize(kept);
    found.resize(kept);
}

}  // namespace

std::vector<std::size_t> false_readings(const RecordRows& rows) {
    const std::vector<bool> found = marked(rows);
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i]) indices.push_back(i);
    return indices;
}

void drop_false_readings(RecordRows& rows, bool u0_given, Cleaning& cleaning) {
    constexpr std::size_t kMaxStartRows = 4;  // largest number of rows of such a start
    std::vector<bool> found = marked(rows);
    take_out(rows, found, kMaxStartRows, cleaning);
    const std::size_t before = rows.y.size();
    if (!u0_given) drop_unread_rows(rows, cleaning);
    drop_silent_rows(rows, cleaning);
    found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(before - rows.y.size()));
    take_out(rows, found, 0, cleaning);
}

}  // namespace tunewright
