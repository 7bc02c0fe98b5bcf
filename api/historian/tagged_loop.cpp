#include "api/historian/tagged_loop.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "api/csv/columns/column_facts.h"
#include "api/historian/values/value_cells.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMinRunRows = 3;  ///< rows of a run before times start again

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

std::vector<std::size_t> time_order(const std::vector<double>& t) {
    if (std::ranges::adjacent_find(t, std::greater_equal<>()) == t.end()) return {};
    std::vector<std::size_t> rows(t.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (!std::ranges::is_sorted(t)) std::ranges::stable_sort(rows, {}, [&](std::size_t i) { return t[i]; });
    const auto same_time = [&](std::size_t a, std::size_t b) { return t[a] == t[b]; };
    rows.erase(std::unique(rows.begin(), rows.end(), same_time), rows.end());
    return rows;
}

void put_rows_in_order(TaggedLoop& loop) {
    const std::vector<std::size_t> rows = time_order(loop.t);
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

std::vector<std::string> reading_notes(const TaggedLoop& loop) {
    constexpr std::size_t kMaxNotes = 50;
    std::vector<std::string> out = loop.notes;
    if (loop.bad > 0)
        out.insert(out.begin(), std::to_string(loop.bad) + (loop.bad == 1 ? " value" : " values") +
                                    " of the measurement or the output " + (loop.bad == 1 ? "is" : "are") +
                                    " of bad quality and count" + (loop.bad == 1 ? "s" : "") + " as missing.");
    if (out.size() <= kMaxNotes) return out;
    const std::size_t more = out.size() - kMaxNotes + 1;
    out.resize(kMaxNotes - 1);
    out.push_back(std::to_string(more) + " more findings are left out.");
    return out;
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
