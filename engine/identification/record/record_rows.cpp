#include "engine/identification/record/record_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tunewright {
namespace {

/// The order of the rows that have a time, and that time.
class TimeOrder {
public:
    TimeOrder(const Record& record, Cleaning& cleaning) : record_(record), size_(record.t.size()) {
        std::size_t up = 0, down = 0, same = 0;
        double before = std::nan("");
        for (const double t : record.t) {
            if (!std::isfinite(t)) continue;
            up += t > before ? 1 : 0;
            down += t < before ? 1 : 0;
            same += t == before ? 1 : 0;
            before = t;
        }
        reversed_ = cleaning.reversed = down > 9 * up && down > 2;
        constexpr std::size_t kCoarse = 3;
        if (kCoarse * same > size_ && up + down > 2) spread(cleaning);
    }

    std::size_t row(std::size_t k) const { return reversed_ ? size_ - 1 - k : k; }
    double time(std::size_t k) const { return spread_.empty() ? record_.t[row(k)] : spread_[k]; }

private:
    // A clock of whole seconds under faster samples: each run of equal times lasts until the next one.
    void spread(Cleaning& cleaning) {
        spread_.resize(size_);
        for (std::size_t k = 0; k < size_; ++k) spread_[k] = record_.t[row(k)];
        double usual = 0;
        for (std::size_t k = 0; k < size_;) {
            std::size_t end = k + 1;
            while (end < size_ && spread_[end] == spread_[k]) ++end;
            double step = end < size_ ? spread_[end] - spread_[k] : usual;
            if (!(step > 0)) step = 0;
            usual = step;
            const auto count = static_cast<double>(end - k);
            for (std::size_t i = k + 1; i < end; ++i) spread_[i] += step * static_cast<double>(i - k) / count;
            k = end;
        }
        cleaning.spread = true;
    }

    const Record& record_;
    std::size_t size_;
    bool reversed_ = false;
    std::vector<double> spread_;
};

void add_change(RecordRows& rows, double t, double u) {
    const double now = rows.change_level.empty() ? rows.u_rest : rows.change_level.back();
    if (u == now) return;
    if (!rows.change_time.empty() && rows.change_time.back() == t) {
        rows.change_level.back() = u;
        const std::size_t n = rows.change_level.size();
        const double before = n > 1 ? rows.change_level[n - 2] : rows.u_rest;
        if (u == before) rows.change_time.pop_back(), rows.change_level.pop_back();
        return;
    }
    rows.change_time.push_back(t);
    rows.change_level.push_back(u);
}

/// Whether row k's time is ahead of the two rows below, which go on from `latest`: it is the false one.
bool is_early(const TimeOrder& order, std::size_t k, std::size_t size, double latest) {
    if (k + 2 >= size) return false;
    const double now = order.time(k), next = order.time(k + 1), second = order.time(k + 2);
    return now > next && now > second && next >= latest && second >= next;
}

void count_first(int& count, int& first, int row) {
    if (count++ == 0) first = row;
}

/// Keeps the longest stretch between two usable y with a missing one inside.
class HoleWatch {
public:
    explicit HoleWatch(Cleaning& cleaning) : cleaning_(cleaning) {}
    void missing() { open_ = true; }
    void sample(double t, bool first) {
        if (open_ && !first && t - last_ > cleaning_.hole_to - cleaning_.hole_from) {
            cleaning_.hole_from = last_;
            cleaning_.hole_to = t;
        }
        open_ = false;
        last_ = t;
    }

private:
    Cleaning& cleaning_;
    bool open_ = false;
    double last_ = 0;
};

/// u as it reaches the plant.
double limited(const Record& r, double u, Cleaning& cleaning) {
    if (!r.u_limits || !std::isfinite(u)) return u;
    const double inside = std::clamp(u, (*r.u_limits)[0], (*r.u_limits)[1]);
    cleaning.limited_u += inside != u ? 1 : 0;
    return inside;
}

double median_of_five(std::span<const double> y, std::size_t middle) {
    double v[5] = {y[middle - 2], y[middle - 1], y[middle], y[middle + 1], y[middle + 2]};
    std::nth_element(v, v + 2, v + 5);
    return v[2];
}

/// The value that stands apart; NaN if none does.
double number_apart(std::span<const double> y) {
    constexpr double kApart = 5;
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
    if (others_low > 0 && next_low - low > kApart * others_low && 2 * lows < y.size()) return low;
    if (others_high > 0 && high - next_high > kApart * others_high && 2 * highs < y.size()) return high;
    return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> spikes(std::span<const double> y) {
    const std::size_t n = y.size();
    std::vector<double> away(n, 0);
    double low = y[2], high = y[2];
    for (std::size_t i = 2; i + 2 < n; ++i) {
        const double smooth = median_of_five(y, i);
        low = std::min(low, smooth);
        high = std::max(high, smooth);
        away[i] = std::abs(y[i] - smooth);
    }
    constexpr double kUsual = 0.9, kTimesUsual = 10, kOfRange = 0.25, kAgree = 0.3;
    std::vector<double> sorted = away;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(n - 1));
    std::nth_element(sorted.begin(), usual, sorted.end());
    const double limit = std::max(kTimesUsual * *usual, kOfRange * (high - low));
    if (high <= low) return {};
    std::vector<std::size_t> found;
    for (std::size_t i = 2; i + 2 < n; ++i) {
        if (away[i] <= limit) continue;
        const std::size_t last = away[i + 1] > limit ? i + 1 : i;
        if (last + 2 >= n || away[last + 1] > limit) {
            while (i + 1 < n && away[i + 1] > limit) ++i;
            continue;
        }
        if (std::abs(y[i - 1] - y[last + 1]) < kAgree * away[i]) {
            for (std::size_t k = i; k <= last; ++k) found.push_back(k);
        }
        i = last;
    }
    const std::size_t most = std::max<std::size_t>(3, n / 100);
    return found.size() <= most ? found : std::vector<std::size_t>{};
}

}  // namespace

RecordRows collect_rows(const Record& r, Cleaning& cleaning) {
    RecordRows rows;
    cleaning.from_file = r.line.size() == r.t.size() && !r.line.empty();
    const TimeOrder order(r, cleaning);
    HoleWatch hole(cleaning);
    rows.t.reserve(r.t.size());
    rows.y.reserve(r.t.size());
    rows.number.reserve(r.t.size());
    double latest = 0;
    for (std::size_t k = 0; k < r.t.size(); ++k) {
        const std::size_t i = order.row(k);
        const int number = cleaning.from_file ? r.line[i] : static_cast<int>(i);
        const double t = order.time(k), u = limited(r, r.u[i], cleaning);
        if (!std::isfinite(t) || (!rows.started && !std::isfinite(u))) {
            ++cleaning.without_time;
            continue;
        }
        if (rows.started && t < latest) {
            count_first(cleaning.backward, cleaning.first_backward, number);
            continue;
        }
        if (rows.started && is_early(order, k, r.t.size(), latest)) {
            count_first(cleaning.early_stamps, cleaning.first_early, number);
            continue;
        }
        if (rows.started && t == latest) count_first(cleaning.repeated, cleaning.first_repeated, number);
        if (!rows.started) rows.u_rest = r.u0.value_or(u);
        rows.started = true;
        latest = t;
        if (std::isfinite(u))
            add_change(rows, t, u);
        else
            ++cleaning.missing_u;
        if (!std::isfinite(r.y[i])) {
            ++cleaning.missing_y;
            hole.missing();
            continue;
        }
        hole.sample(t, rows.t.empty());
        rows.t.push_back(t);
        rows.y.push_back(r.y[i]);
        rows.number.push_back(number);
    }
    return rows;
}

namespace {

void drop_first(RecordRows& rows, std::ptrdiff_t count) {
    rows.t.erase(rows.t.begin(), rows.t.begin() + count);
    rows.y.erase(rows.y.begin(), rows.y.begin() + count);
    rows.number.erase(rows.number.begin(), rows.number.begin() + count);
}

}  // namespace

void drop_unread_rows(RecordRows& rows, Cleaning& cleaning) {
    constexpr std::size_t kMost = 3, kMin = 12;  // rows: left out; of a record that shows how far it moves
    if (rows.t.size() < kMin || rows.change_time.size() < 2) return;
    const auto range = [](auto from, auto to) {
        const auto [low, high] = std::minmax_element(from, to);
        return *high - *low;
    };
    const auto jump = rows.change_time.front();
    const auto first = std::lower_bound(rows.t.begin(), rows.t.end(), jump) - rows.t.begin();
    if (first < 1 || static_cast<std::size_t>(first) > kMost || rows.t[static_cast<std::size_t>(first)] != jump) return;
    const double y_jump =
        std::abs(rows.y[static_cast<std::size_t>(first)] - rows.y[static_cast<std::size_t>(first) - 1]);
    const double u_jump = std::abs(rows.change_level.front() - rows.u_rest);
    if (y_jump <= range(rows.y.begin() + first, rows.y.end()) || range(rows.y.begin(), rows.y.begin() + first) > 0)
        return;
    if (u_jump <= range(rows.change_level.begin(), rows.change_level.end())) return;
    rows.u_rest = rows.change_level.front();
    rows.change_time.erase(rows.change_time.begin());
    rows.change_level.erase(rows.change_level.begin());
    drop_first(rows, first);
    cleaning.unread = static_cast<int>(first);
}

void drop_silent_rows(RecordRows& rows, Cleaning& cleaning) {
    constexpr double kFarther = 10;  // than y moves between any rows that follow
    const auto held = std::adjacent_find(rows.y.begin(), rows.y.end(), std::not_equal_to<>());
    if (held == rows.y.end()) return;
    const auto first = held + 1 - rows.y.begin();
    const double began = rows.t[static_cast<std::size_t>(first)];
    if (!rows.change_time.empty() && rows.change_time.front() <= began) return;
    double farthest = 0;
    for (auto y = rows.y.begin() + first; y + 1 != rows.y.end(); ++y)
        farthest = std::max(farthest, std::abs(y[1] - *y));
    if (std::abs(held[1] - *held) <= kFarther * farthest || farthest == 0) return;
    drop_first(rows, first);
    cleaning.silent = static_cast<int>(first);
}

void drop_late_moves(RecordRows& rows, Cleaning& cleaning) {
    constexpr std::size_t kThereAndBack = 2;
    if (rows.change_time.size() > kThereAndBack) return;
    while (rows.change_time.size() > 1 && !rows.t.empty() && rows.change_time.back() >= rows.t.back()) {
        rows.change_time.pop_back();
        rows.change_level.pop_back();
        ++cleaning.late_moves;
    }
}

std::vector<std::size_t> false_readings(std::span<const double> y) {
    constexpr std::size_t kMin = 12;  // fewer samples show no usual move
    if (y.size() < kMin) return {};
    const double apart = number_apart(y);
    if (std::isnan(apart)) return spikes(y);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (y[i] == apart) found.push_back(i);
    }
    return found;
}

void drop_false_readings(RecordRows& rows, Cleaning& cleaning) {
    const std::vector<std::size_t> found = false_readings(rows.y);
    if (found.empty()) return;
    std::size_t next = 0, kept = 0;
    for (std::size_t i = 0; i < rows.y.size(); ++i) {
        if (next < found.size() && found[next] == i) {
            cleaning.spikes.push_back(rows.number[i]);
            cleaning.spike_times.push_back(rows.t[i]);
            ++next;
            continue;
        }
        rows.t[kept] = rows.t[i];
        rows.y[kept] = rows.y[i];
        rows.number[kept] = rows.number[i];
        ++kept;
    }
    rows.t.resize(kept);
    rows.y.resize(kept);
    rows.number.resize(kept);
}

}  // namespace tunewright
