#include "api/csv/shape/pivot.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/csv/cell.h"

namespace tunewright::api {

void add_line(ShapedText& table, const std::vector<std::string_view>& cells, int line) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        table.text += i > 0 ? ",\"" : "\"";
        for (const char c : cells[i]) {
            if (c == '"') table.text += '"';
            table.text += c == '\n' || c == '\r' ? ' ' : c;
        }
        table.text += '"';
    }
    table.text += '\n';
    table.lines.push_back(line);
}

std::size_t Pivot::tag_index(std::string_view tag) {
    // Few tags, and mostly the one of the entry before.
    if (!entries_.empty() && tags_[entries_.back().tag] == tag) return entries_.back().tag;
    const auto known = std::ranges::find(tags_, tag);
    if (known != tags_.end()) return static_cast<std::size_t>(known - tags_.begin());
    tags_.emplace_back(tag);
    return tags_.size() - 1;
}

void Pivot::add(std::string_view time, std::string_view tag, std::string_view value, int line) {
    Entry entry{{}, std::string(time), std::string(value), 0, line};
    const auto day = read_time_stamp(time, DateOrder::day_first);
    if (double number = 0; (!day || is_compact_stamp(time)) && !day && read_cell_number(time, number)) {
        entry.key[0] = entry.key[1] = number;
    } else if (day) {
        const auto month = read_time_stamp(time, DateOrder::month_first);
        entry.key[0] = day->seconds;
        entry.key[1] = month ? month->seconds : day->seconds;
    } else {
        return;
    }
    entry.tag = tag_index(tag);
    entries_.push_back(std::move(entry));
}

ShapedText Pivot::table(std::string_view time_heading) const {
    // Of the two readings of 03/04/2026 the one is right in which time runs on.
    double way[2] = {};
    for (std::size_t i = 1; i < entries_.size(); ++i)
        for (int k = 0; k < 2; ++k) way[k] += std::abs(entries_[i].key[k] - entries_[i - 1].key[k]);
    const int order = way[1] < way[0] ? 1 : 0;
    std::vector<std::size_t> by_time(entries_.size());
    std::iota(by_time.begin(), by_time.end(), std::size_t{0});
    std::ranges::stable_sort(by_time, {}, [&](std::size_t i) { return entries_[i].key[order]; });

    ShapedText out;
    out.pivoted = true;
    std::vector<std::string_view> cells = {time_heading};
    cells.insert(cells.end(), tags_.begin(), tags_.end());
    add_line(out, cells, 1);
    for (std::size_t i = 0; i < by_time.size();) {
        const Entry& first = entries_[by_time[i]];
        cells.assign(tags_.size() + 1, {});
        cells[0] = first.time;
        std::vector<bool> filled(tags_.size(), false);
        for (; i < by_time.size(); ++i) {
            const Entry& entry = entries_[by_time[i]];
            if (entry.key[order] != first.key[order] || filled[entry.tag]) break;
            filled[entry.tag] = true;
            cells[entry.tag + 1] = entry.value;
        }
        add_line(out, cells, first.line);
    }
    return out;
}

}  // namespace tunewright::api
