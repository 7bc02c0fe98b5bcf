#include "api/csv/shape/pivot.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/csv/cell.h"
#include "api/csv/column_choice.h"

namespace tunewright::api {

std::string too_many_columns(std::size_t columns) {
    return "csv has " + std::to_string(columns) + " columns; at most " + std::to_string(kMaxColumns) +
           " are read. Export only those of time, u, y and the set point.";
}

void add_line(ShapedText& table, const std::vector<std::string_view>& cells, int line) {
    if (!table.fault.empty()) return;
    table.cells += cells.size();
    if (table.cells > kMaxTableCells) {
        table.fault = "csv has " + std::to_string(cells.size()) +
                      " names of values, and rows for a table of more than " +
                      std::to_string(kMaxTableCells / 1'000'000) +
                      " million cells. Export only the values of u, y and the set point, or a shorter part.";
        table.text.clear();
        return;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) table.text += ',';
        // An empty cell alone in its line would be a blank line.
        if (cells[i].empty() && cells.size() > 1) continue;
        table.text += '"';
        for (const char c : cells[i]) {
            if (c == '"') table.text += '"';
            table.text += c == '\n' || c == '\r' ? ' ' : c;
        }
        table.text += '"';
    }
    table.text += '\n';
    table.lines.push_back(line);
}

std::optional<std::size_t> Pivot::tag_index(std::string_view tag) {
    // Usually the tag of the previous entry.
    if (!entries_.empty() && tags_[entries_.back().tag] == tag) return entries_.back().tag;
    const auto known = places_.find(std::string(tag));
    if (known != places_.end()) return known->second;
    if (tags_.size() == kMaxTags) return std::nullopt;
    tags_.emplace_back(tag);
    places_.emplace(tag, tags_.size() - 1);
    return tags_.size() - 1;
}

bool Pivot::add(std::string_view time, std::string_view tag, std::string_view value, int line) {
    Entry entry{{}, std::string(time), std::string(value), 0, line};
    const auto day = read_time_stamp(time, DateOrder::day_first);
    if (double number = 0; (!day || is_compact_stamp(time)) && !day && read_cell_number(time, number)) {
        entry.key[0] = entry.key[1] = number;
    } else if (day) {
        const auto month = read_time_stamp(time, DateOrder::month_first);
        entry.key[0] = day->seconds;
        entry.key[1] = month ? month->seconds : day->seconds;
    } else {
        return true;
    }
    const auto index = tag_index(tag);
    if (!index) return false;
    entry.tag = *index;
    entries_.push_back(std::move(entry));
    return true;
}

ShapedText Pivot::table(std::string_view time_heading) const {
    // 03/04/2026 has two readings: the right one is that in which time increases.
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
    for (std::size_t i = 0; i < by_time.size() && out.fault.empty();) {
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
