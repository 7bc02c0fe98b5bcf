#include "engine/identification/record/record_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tunewright {
namespace {

/// Number of times that the time rises, falls and stays equal from one row to the next.
struct TimeMoves {
    std::size_t up = 0, down = 0, same = 0;

    explicit TimeMoves(const Record& record) {
        double before = std::nan("");
        for (const double t : record.t) {
            if (!std::isfinite(t)) continue;
            up += t > before ? 1 : 0;
            down += t < before ? 1 : 0;
            same += t == before ? 1 : 0;
            before = t;
        }
    }
    bool fall() const { return down > 9 * up && down > 2; }
};

/// The order of the rows that have a time, and that time.
class TimeOrder {
public:
    TimeOrder(const Record& record, Cleaning& cleaning) : record_(record), size_(record.t.size()) {
        const TimeMoves moves(record);
        reversed_ = cleaning.reversed = moves.fall();
        constexpr std::size_t kMinRowsPerRepeat = 3;
        if (kMinRowsPerRepeat * moves.same > size_ && moves.up + moves.down > 2) spread(cleaning);
    }

    std::size_t row(std::size_t k) const { return reversed_ ? size_ - 1 - k : k; }
    double time(std::size_t k) const { return spread_.empty() ? record_.t[row(k)] : spread_[k]; }

private:
    // For a clock of whole seconds with faster samples: each run of equal times is spread until the next time.
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

/// True if row k's time is ahead of the two rows below, which continue from `latest`: then row k's time is false.
bool is_early(const TimeOrder& order, std::size_t k, std::size_t size, double latest) {
    if (k + 2 >= size) return false;
    const double now = order.time(k), next = order.time(k + 1), second = order.time(k + 2);
    return now > next && now > second && next >= latest && second >= next;
}

void count_first(int& count, int& first, int row) {
    if (count++ == 0) first = row;
}

/// Finds the longest interval between two usable y with a missing one inside.
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

/// u limited to the range of the actuator: the plant's input.
double limited(const Record& r, double u, Cleaning& cleaning) {
    if (!r.u_limits || !std::isfinite(u)) return u;
    const double inside = std::clamp(u, (*r.u_limits)[0], (*r.u_limits)[1]);
    cleaning.limited_u += inside != u ? 1 : 0;
    return inside;
}

}  // namespace

bool times_fall(const Record& record) { return TimeMoves(record).fall(); }

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
    constexpr std::size_t kMaxLeadingRows = 3,
                          kMinRows = 12;  // rows: number that may be removed; number that shows the usual movement
    if (rows.t.size() < kMinRows || rows.change_time.size() < 2) return;
    const auto range = [](auto from, auto to) {
        const auto [low, high] = std::minmax_element(from, to);
        return *high - *low;
    };
    const auto jump = rows.change_time.front();
    const auto first = std::lower_bound(rows.t.begin(), rows.t.end(), jump) - rows.t.begin();
    if (first < 1 || static_cast<std::size_t>(first) > kMaxLeadingRows ||
        rows.t[static_cast<std::size_t>(first)] != jump)
        return;
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
    constexpr double kMinMoveRatio = 10;  // multiple of the movement of y between any later rows
    const auto held = std::adjacent_find(rows.y.begin(), rows.y.end(), std::not_equal_to<>());
    if (held == rows.y.end()) return;
    const auto first = held + 1 - rows.y.begin();
    const double began = rows.t[static_cast<std::size_t>(first)];
    if (!rows.change_time.empty() && rows.change_time.front() <= began) return;
    double farthest = 0;
    for (auto y = rows.y.begin() + first; y + 1 != rows.y.end(); ++y)
        farthest = std::max(farthest, std::abs(y[1] - *y));
    if (std::abs(held[1] - *held) <= kMinMoveRatio * farthest || farthest == 0) return;
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

}  // namespace tunewright
