#include "api/csv/table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

// Lines up to the end; \n, \r\n and \r end one.
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at) {
    if (at >= text.size()) return std::nullopt;
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n') ++at;
    return line;
}

std::size_t count_outside_quotes(std::string_view line, char separator) {
    std::size_t count = 0;
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == separator && !quoted) ++count;
    }
    return count;
}

// A tab or semicolon in every one of the first lines is never there by chance; a comma may be a decimal sign.
char find_separator(std::string_view text) {
    constexpr int kLooked = 5;
    for (const char separator : {'\t', ';'}) {
        std::size_t at = 0;
        int lines = 0, with = 0;
        while (lines < kLooked) {
            const auto line = next_line(text, at);
            if (!line) break;
            const std::string_view content = trimmed(*line);
            if (content.empty() || content.front() == '#') continue;
            ++lines;
            if (count_outside_quotes(content, separator) > 0) ++with;
        }
        if (lines > 0 && with == lines) return separator;
    }
    return ',';
}

std::string_view blanks_removed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\r')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

std::string_view unquote(std::string_view cell, std::deque<std::string>& storage) {
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
    const std::string_view inner = cell.substr(1, cell.size() - 2);
    if (inner.find("\"\"") == inner.npos) return trimmed(inner);
    std::string single;
    for (std::size_t i = 0; i < inner.size(); ++i) {
        single += inner[i];
        if (inner[i] == '"') ++i;
    }
    storage.push_back(std::move(single));
    return trimmed(storage.back());
}

void split(std::string_view line, char separator, std::vector<std::string_view>& cells,
           std::deque<std::string>& storage) {
    std::size_t start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') quoted = !quoted;
        if (i == line.size() || (line[i] == separator && !quoted)) {
            cells.push_back(unquote(blanks_removed(line.substr(start, i - start)), storage));
            start = i + 1;
        }
    }
}

bool holds_data(std::string_view cell) {
    double number = 0;
    return read_cell_number(cell, number) || read_time_stamp(cell).has_value();
}

// Headings: no cell is a number or a time, and at least one is a text that is not a mark for "missing".
bool is_text_line(const std::vector<std::string_view>& cells) {
    bool text = false;
    for (const std::string_view cell : cells) {
        if (holds_data(cell)) return false;
        text = text || !is_missing(cell);
    }
    return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool read_cell_number(std::string_view cell, double& value) {
    if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
    if (cell.empty() || !(std::isdigit(static_cast<unsigned char>(cell.front())) || cell.front() == '-' ||
                          cell.front() == '.' || cell.front() == ','))
        return false;
    char buffer[64];
    if (const std::size_t comma = cell.find(','); comma != cell.npos) {
        if (cell.size() > sizeof buffer || cell.find('.') != cell.npos || cell.find(',', comma + 1) != cell.npos)
            return false;
        std::copy(cell.begin(), cell.end(), buffer);
        buffer[comma] = '.';
        cell = {buffer, cell.size()};
    }
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
}

bool is_missing(std::string_view cell) {
    if (cell.empty() || cell == "-" || cell == "--" || cell == "?") return true;
    constexpr std::size_t kLongest = 8;
    if (cell.size() > kLongest) return false;
    static constexpr std::array<std::string_view, 10> kMarks = {"nan",  "na",  "n/a",   "null",    "none",
                                                                "#n/a", "#na", "#num!", "#value!", "nil"};
    const std::string word = lower_case(cell.front() == '-' ? cell.substr(1) : cell);
    return std::find(kMarks.begin(), kMarks.end(), word) != kMarks.end();
}

CsvTable read_table(std::string_view text) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    CsvTable table;
    table.separator = find_separator(text);
    std::size_t at = 0;
    int number = 0;
    bool first = true;
    while (const auto line = next_line(text, at)) {
        ++number;
        const std::string_view content = trimmed(*line);
        if (content.empty() || content.front() == '#') continue;
        CsvTable::Line next{number, {}};
        next.cells.reserve(table.headings.size());
        split(*line, table.separator, next.cells, table.unquoted);
        if (first && is_text_line(next.cells)) {
            for (const std::string_view cell : next.cells) table.headings.emplace_back(cell);
        } else if (table.lines.empty() && table.units.number == 0 && !table.headings.empty() &&
                   is_text_line(next.cells)) {
            table.units = std::move(next);
        } else {
            table.lines.push_back(std::move(next));
        }
        first = false;
    }
    return table;
}

}  // namespace tunewright::api
