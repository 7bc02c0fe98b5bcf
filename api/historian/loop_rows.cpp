#include "api/historian/loop_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "api/csv/columns/column_facts.h"
#include "api/historian/value_cells.h"

namespace tunewright::api {
namespace {

constexpr double kSilence = 2.5;          ///< usual spacings
constexpr double kRegularShare = 0.8;     ///< of the spacings that are usual in a sampled record
constexpr double kUsualTolerance = 0.2;   ///< relative, of a usual spacing
constexpr std::size_t kMinRunRows = 3;    ///< rows of a run before times start again

/// The rows in the order of time, without those at the time of an earlier one; empty if they are so already.
std::vector<std::size_t> ordered(const std::vector<double>& t) {
    if (std::ranges::adjacent_find(t, std::greater_equal<>()) == t.end()) return {};
    std::vector<std::size_t> rows(t.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (!std::ranges::is_sorted(t)) std::ranges::stable_sort(rows, {}, [&](std::size_t i) { return t[i]; });
    const auto rest = std::ranges::unique(rows, {}, [&](std::size_t i) { return t[i]; });
    rows.erase(rest.begin(), rest.end());
    return rows;
}

template <class Column>
void take_rows(const std::vector<std::size_t>& rows, Column& column) {
    if (column.empty()) return;
    Column out;
    out.reserve(rows.size());
    for (const std::size_t i : rows) out.push_back(column[i]);
    column = std::move(out);
}

/// The median of the spacings; 0 if there are none.
double usual_spacing(const std::vector<double>& t) {
    if (t.size() < 2) return 0;
    std::vector<double> spacings(t.size() - 1);
    for (std::size_t i = 1; i < t.size(); ++i) spacings[i - 1] = t[i] - t[i - 1];
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::ranges::nth_element(spacings, middle);
    return *middle;
}

bool is_sampled(const std::vector<double>& t, double usual) {
    std::size_t near = 0;
    for (std::size_t i = 1; i < t.size(); ++i)
        near += std::abs(t[i] - t[i - 1] - usual) <= kUsualTolerance * usual ? 1 : 0;
    return static_cast<double>(near) >= kRegularShare * static_cast<double>(t.size() - 1);
}

/// The times of the rows: those of y, and those of u where y is silent.
std::vector<double> row_times(const std::vector<double>& y, const std::vector<double>& u) {
    const double usual = usual_spacing(y);
    if (y.size() < 2 || is_sampled(y, usual)) return y;
    std::vector<double> out;
    out.reserve(y.size());
    auto next = u.begin();
    const auto add_silence = [&](double from, double to) {
        next = std::upper_bound(next, u.end(), from);
        while (next != u.end() && *next < to) out.push_back(*next++);
    };
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (i > 0 && y[i] - y[i - 1] > kSilence * usual) add_silence(y[i - 1], y[i]);
        out.push_back(y[i]);
    }
    if (!u.empty() && u.back() - y.back() > kSilence * usual) add_silence(y.back(), std::nextafter(u.back(), INFINITY));
    return out;
}

/// The values at ascending times, each held until the next one; NaN before the first.
std::vector<double> held_at(const std::vector<double>& times, const TagValues& tag) {
    std::vector<double> out;
    out.reserve(times.size());
    std::size_t next = 0;
    for (const double t : times) {
        while (next < tag.t.size() && tag.t[next] <= t) ++next;
        out.push_back(next > 0 ? tag.value[next - 1] : kNoNumber);
    }
    return out;
}

bool has_number(const std::vector<double>& values) {
    return std::ranges::any_of(values, [](double value) { return !std::isnan(value); });
}

bool newest_first(const std::vector<double>& t) {
    std::size_t up = 0, down = 0;
    for (std::size_t i = 1; i < t.size(); ++i) {
        up += t[i] > t[i - 1] ? 1 : 0;
        down += t[i] < t[i - 1] ? 1 : 0;
    }
    return down > up;
}

}  // namespace

void put_in_order(TagValues& tag) {
    const std::vector<std::size_t> rows = ordered(tag.t);
    if (rows.empty()) return;
    take_rows(rows, tag.value);
    take_rows(rows, tag.t);
}

void put_in_order(TagModes& tag) {
    const std::vector<std::size_t> rows = ordered(tag.t);
    if (rows.empty()) return;
    take_rows(rows, tag.mode);
    take_rows(rows, tag.t);
}

void join_tags(const TagValues& y, const TagValues& u, const TagValues& r, const TagModes& mode, TaggedLoop& loop) {
    loop.t = row_times(y.t, u.t);
    loop.y = held_at(loop.t, y);
    loop.u = held_at(loop.t, u);
    if (!r.t.empty()) loop.r = held_at(loop.t, r);
    if (mode.t.empty()) return;
    loop.mode.reserve(loop.t.size());
    std::size_t next = 0;
    for (const double t : loop.t) {
        while (next < mode.t.size() && mode.t[next] <= t) ++next;
        loop.mode.push_back(next > 0 ? mode.mode[next - 1] : std::uint8_t{0});
    }
}

void put_rows_in_order(TaggedLoop& loop) {
    const std::vector<std::size_t> rows = ordered(loop.t);
    if (rows.empty()) return;
    const std::size_t same = loop.t.size() - rows.size();
    for (auto* column : {&loop.y, &loop.u, &loop.r, &loop.t}) take_rows(rows, *column);
    take_rows(rows, loop.mode);
    if (same > 0)
        loop.notes.push_back(std::to_string(same) + (same == 1 ? " row has" : " rows have") +
                             " the time of another one and " + (same == 1 ? "was" : "were") + " left out.");
}

void hold(std::vector<double>& r) {
    double last = kNoNumber;
    for (double& value : r) last = value = std::isnan(value) ? last : value;
}

void take_mode_words(const ModeTrack& track, const std::string& tag, TaggedLoop& loop) {
    loop.mode_words = track.words();
    if (loop.mode_words.size() > 1) return;
    loop.mode = {};
    loop.mode_words = {};
    if (!track.unknown_code().empty())
        loop.notes.push_back("The mode " + in_quotes(tag) + " holds codes such as " + track.unknown_code() +
                             " whose meaning is not stated; it is not read. Name it such as \"Mode (0=MAN, 1=AUTO)\".");
}

void set_fault(TaggedLoop& loop, std::string sentence) {
    for (auto* column : {&loop.t, &loop.y, &loop.u, &loop.r}) *column = {};
    loop.mode = {};
    loop.fault = std::move(sentence);
}

void refuse_empty(TaggedLoop& loop, const std::string& y_name, const std::string& u_name) {
    for (const auto& [column, name] : {std::pair{&loop.y, &y_name}, std::pair{&loop.u, &u_name}}) {
        if (has_number(*column)) continue;
        set_fault(loop, *name + (loop.bad > 0 ? " has no value of good quality." : " has no number.") +
                     " Export it again, or leave this loop out.");
        return;
    }
}

int continue_restarted(std::vector<double>& t) {
    if (t.size() <= kMinRunRows || newest_first(t)) return 0;
    int restarts = 0;
    double moved = 0, first = t.front(), last = t.front();
    std::size_t rows = 1;
    for (std::size_t i = 1; i < t.size(); ++i, ++rows) {
        double now = t[i] + moved;
        // A single earlier time is out of order; a restart goes on from there.
        const bool falls = now < last && last - now > (last - first) / 2 && rows >= kMinRunRows;
        if (falls && i + 1 < t.size() && t[i + 1] > t[i] && t[i + 1] + moved < last) {
            const double step = t[i - 1] - t[i - 2];
            moved += last - now + std::max(step, 0.0);
            now = t[i] + moved;
            first = now;
            rows = 0;
            ++restarts;
        }
        t[i] = now;
        last = std::max(last, now);
    }
    return restarts;
}

}  // namespace tunewright::api
