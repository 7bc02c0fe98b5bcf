#include "api/csv/table_headings.h"

#include <algorithm>
#include <map>

#include "api/csv/cell.h"
#include "api/csv/columns/heading.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

bool holds_data(std::string_view cell) {
    double number = 0;
    return read_cell_number(cell, number, DecimalSign::either, unit_suffix(cell)) || read_time_stamp(cell).has_value();
}

// True if there is a heading for each column other than the first, which numbers the rows: the format of R.
bool counts_rows(const std::vector<CsvLine>& data) {
    constexpr std::size_t kProbedRows = 5;
    double before = 0;
    for (std::size_t i = 0; i < std::min(data.size(), kProbedRows); ++i) {
        double number = 0;
        if (!read_cell_number(data[i].cells.front(), number) || (i > 0 && number != before + 1)) return false;
        before = number;
    }
    return data.size() > 1;
}

// The index of the headings among the lines of text right above the data with the same width: the others are a title,
// units or descriptions.
std::size_t heading_among(const std::vector<CsvLine>& above, std::size_t first) {
    std::size_t best = first, max = 0;
    int named = 0;
    for (std::size_t i = first; i < above.size(); ++i) max = std::max(max, filled(above[i].cells));
    while (best + 1 < above.size() && 2 * filled(above[best].cells) <= max) ++best;
    for (std::size_t i = best; i < above.size(); ++i) {
        const int now = roles_named(above[i].cells);
        if (now <= named) continue;
        named = now;
        best = i;
    }
    return best;
}

/// Tags in one line and descriptions in another: cells that are empty in the line of headings are filled from the other
/// one.
void fill_from(const std::vector<CsvLine>& above, std::size_t first, std::size_t at, CsvLayout& layout) {
    for (std::size_t column = 0; column < layout.headings.size(); ++column) {
        if (!layout.headings[column].empty()) continue;
        for (std::size_t line = at; line-- > first && layout.headings[column].empty();)
            if (column < above[line].cells.size()) layout.headings[column] = std::string(above[line].cells[column]);
    }
}

}  // namespace

int roles_named(const std::vector<std::string_view>& cells) {
    int named = 0;
    for (const std::string_view cell : cells) {
        const Heading heading = split_heading(cell);
        for (const ColumnRole role : {kTimeRole, kInputRole, kOutputRole, kReferenceRole}) {
            const auto found = match(heading, role);
            if (!found || found->level > 2) continue;
            ++named;
            break;
        }
    }
    return named;
}

void take_headings(const CsvLine& line, CsvLayout& layout) {
    layout.heading_line = line.number;
    for (const std::string_view cell : line.cells) {
        layout.headings.emplace_back(cell);
        std::ranges::replace_if(
            layout.headings.back(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    }
}

std::size_t filled(const std::vector<std::string_view>& cells) {
    std::size_t count = cells.size();
    while (count > 0 && cells[count - 1].empty()) --count;
    return count;
}

std::size_t usual_width(const std::vector<CsvLine>& lines) {
    std::map<std::size_t, int> counts;
    for (const CsvLine& line : lines) ++counts[line.cells.size()];
    std::size_t width = 0;
    int max = 0;
    for (const auto& [count, times] : counts) {
        if (times < max) continue;
        width = count;
        max = times;
    }
    return width;
}

bool is_data(const CsvLine& line, std::size_t width) {
    std::size_t data = 0, missing = 0;
    for (const std::string_view cell : line.cells) {
        if (is_missing(cell))
            ++missing;
        else if (holds_data(cell))
            ++data;
    }
    return data > 0 && 2 * (data + missing) >= line.cells.size() && line.cells.size() >= width &&
           filled(line.cells) <= width + 1;
}

bool is_text(const CsvLine& line) {
    bool text = false;
    for (const std::string_view cell : line.cells) {
        if (holds_data(cell)) return false;
        text = text || !is_missing(cell);
    }
    return text;
}

std::vector<CsvLine> filled_lines(std::vector<CsvLine> lines) {
    std::erase_if(lines, [](const CsvLine& line) { return filled(line.cells) == 0; });
    return lines;
}

std::vector<CsvLine>::const_iterator first_data(const std::vector<CsvLine>& lines, std::size_t usual,
                                                std::size_t width) {
    constexpr std::ptrdiff_t kMaxTitleLines = 10;
    const auto is_row = [&](const CsvLine& line) { return is_data_of(line, usual, width); };
    const auto is_heading = [](const CsvLine& line) { return is_text(line) && roles_named(line.cells) > 1; };
    const auto first = std::find_if(lines.begin(), lines.end(), is_row);
    if (std::any_of(lines.begin(), first, is_heading)) return first;
    const auto last_title = first + std::min(kMaxTitleLines, lines.end() - first);
    const auto heading = std::find_if(first, last_title, is_heading);
    return heading == last_title ? first : std::find_if(heading, lines.end(), is_row);
}

void find_headings(const std::vector<CsvLine>& above, const std::vector<CsvLine>& data, CsvLayout& layout) {
    std::size_t first = above.size();
    while (first > 0) {
        const CsvLine& line = above[first - 1];
        const bool wide =
            line.cells.size() == layout.width || filled(line.cells) == layout.width ||
            (filled(line.cells) >= 2 && line.cells.size() + 1 >= layout.width && line.cells.size() <= layout.width + 1);
        if (!wide || !is_text(line)) break;
        --first;
    }
    layout.skipped = static_cast<int>(first);
    if (first == above.size()) {
        if (above.empty() || !is_text(above.back()) || filled(above.back().cells) < 2) return;
        if (const std::size_t count = filled(above.back().cells); count > layout.width && layout.width > 1) {
            take_headings(above.back(), layout);
            layout.headings.resize(count);
            layout.surplus.assign(layout.headings.begin() + static_cast<std::ptrdiff_t>(layout.width),
                                  layout.headings.end());
            layout.headings.resize(layout.width);
            --layout.skipped;
            return;
        }
        layout.narrow_heading_line = above.back().number;
        layout.narrow_heading_cells = filled(above.back().cells);
        return;
    }
    const std::size_t at = heading_among(above, first);
    layout.skipped = static_cast<int>(at);
    take_headings(above[at], layout);
    fill_from(above, first, at, layout);
    layout.below.assign(above.begin() + static_cast<std::ptrdiff_t>(at) + 1, above.end());
    if (above[at].cells.size() + 1 != layout.width || !counts_rows(data) || data.front().cells.back().empty()) return;
    layout.numbered = true;
    layout.headings.insert(layout.headings.begin(), "");
}

std::optional<CsvLine> commented_headings(int number, std::string_view line, CsvLayout& layout) {
    const std::string_view whole = trimmed(line);
    for (const std::string_view content :
         {trimmed(whole.substr(std::min(whole.find_first_not_of("#/%"), whole.size()))), whole}) {
        for (const char separator : {layout.separator, ',', ';', '\t', '|', ' '}) {
            CsvLine cells{number, {}};
            split_line(content, separator, cells.cells, layout.unquoted);
            while (!cells.cells.empty() && cells.cells.back().empty() && cells.cells.size() > layout.width)
                cells.cells.pop_back();
            if (layout.width < 2 || cells.cells.size() != layout.width || !is_text(cells)) continue;
            if ((separator == layout.separator && separator != ' ') || roles_named(cells.cells) > 0) return cells;
        }
    }
    return std::nullopt;
}

void widen_to_headings(const std::vector<CsvLine>& lines, CsvLayout& layout) {
    const auto heading = std::find_if(lines.begin(), lines.end(), [&](const CsvLine& line) {
        return filled(line.cells) > layout.width && is_text(line) && roles_named(line.cells) > 1;
    });
    if (heading == lines.end()) return;
    const std::size_t width = filled(heading->cells);
    const bool full = std::any_of(
        heading, lines.end(), [&](const CsvLine& line) { return filled(line.cells) == width && is_data(line, width); });
    if (full) layout.width = width;
}

bool is_data_of(const CsvLine& line, std::size_t usual, std::size_t width) {
    return is_data(line, usual) || (width > usual && is_data(line, width));
}

}  // namespace tunewright::api
