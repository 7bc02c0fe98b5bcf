#include "api/csv/table.h"

#include <algorithm>
#include <map>

#include "api/csv/columns/heading.h"
#include "api/csv/table_headings.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

constexpr int kProbedLines = 200;

std::string_view blanks_removed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

std::string_view unquote(std::string_view cell, std::deque<std::string>& storage) {
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
    const std::string_view inner = cell.substr(1, cell.size() - 2);
    if (inner.find("\"\"") == inner.npos) return trimmed(inner);
    std::string single;
    for (std::size_t i = 0; i < inner.size(); ++i) {
        single += inner[i];
        // Only a doubled quote stands for a quote; a single one in the middle is an error of the writer and is kept.
        if (inner[i] == '"' && inner.substr(i + 1, 1) == "\"") ++i;
    }
    storage.push_back(std::move(single));
    return trimmed(storage.back());
}

void split_at_blanks(std::string_view line, std::vector<std::string_view>& cells, std::deque<std::string>& storage) {
    for (std::size_t at = 0; at < line.size();) {
        if (line[at] == ' ' || line[at] == '\t') {
            ++at;
            continue;
        }
        std::size_t end = line[at] == '"' ? line.find('"', at + 1) : line.find_first_of(" \t", at);
        if (end != line.npos && line[at] == '"') ++end;
        end = std::min(end, line.size());
        cells.push_back(unquote(line.substr(at, end - at), storage));
        at = end;
    }
}

/// A line above the data or among its first ones, with its place in the text.
struct Head {
    int number = 0;
    std::size_t at = 0;
    std::string_view content;
    bool comment = false;
};

/// True if a quote that begins a cell of this line is not closed in it.
bool opens_cell(std::string_view line) {
    const auto quotes = std::count(line.begin(), line.end(), '"');
    if (quotes % 2 == 0) return false;
    const std::size_t last = line.rfind('"');
    return last == 0 || std::string_view(",;\t| ").find(line[last - 1]) != std::string_view::npos;
}

/// Completes a cell such as "Time<line break>(min)", a heading of a spreadsheet: `content`, which begins at `start`, is
/// extended to the quote that closes it. Returns the number of added lines; 0 if none of the next few closes it.
int take_rest_of_cell(std::string_view text, std::size_t start, std::size_t& at, std::string_view& content) {
    constexpr int kMaxFurtherLines = 6;
    std::size_t next = at;
    for (int more = 1; more <= kMaxFurtherLines; ++more) {
        const std::size_t begin = next;
        const auto line = next_line(text, next);
        if (!line) return 0;
        const std::string_view whole = text.substr(start, begin - start + line->size());
        if (opens_cell(whole) || std::count(whole.begin(), whole.end(), '"') % 2 != 0) continue;
        content = whole;
        at = next;
        return more;
    }
    return 0;
}

std::vector<Head> first_lines(std::string_view text) {
    std::vector<Head> lines;
    std::size_t at = 0, start = 0;
    for (int number = 1; static_cast<int>(lines.size()) < kProbedLines; ++number) {
        start = at;
        const auto line = next_line(text, at);
        if (!line) break;
        const std::string_view content = trimmed(*line);
        if (content.empty()) continue;
        lines.push_back({number, start, *line, is_comment(content)});
        if (opens_cell(content)) number += take_rest_of_cell(text, start, at, lines.back().content);
    }
    return lines;
}

// The share of cells that look like numbers with a decimal point or comma.
double share_of_numbers(const std::vector<Head>& lines, char separator) {
    std::deque<std::string> storage;
    std::vector<std::string_view> cells;
    std::size_t numbers = 0, all = 0;
    for (const Head& line : lines) {
        if (line.comment) continue;
        split_line(line.content, separator, cells, storage);
        all += cells.size();
        numbers += static_cast<std::size_t>(std::ranges::count_if(cells, [](std::string_view cell) {
            cell = trimmed(cell);
            return !cell.empty() && cell.find_first_not_of("0123456789.,+-eE") == std::string_view::npos;
        }));
    }
    return all > 0 ? static_cast<double>(numbers) / static_cast<double>(all) : 0;
}

// The separator that splits most lines into the same number of cells, more than one. Separators that hardly occur by
// chance come first, unless only another one also splits the first line in that way and leaves more numbers:
// "ns=2;s=Tank" holds one that separates nothing, and "Tank 5, heater, test" has as many commas as "0;0,00;20,00".
char find_separator(const std::vector<Head>& lines) {
    char best = ',';
    double best_share = 0;
    std::deque<std::string> storage;
    std::vector<std::string_view> cells;
    std::optional<char> plain;
    for (const char separator : {'\t', ';', '|', ',', ' '}) {
        std::map<std::size_t, int> counts;
        std::size_t first = 0;
        int all = 0;
        for (const Head& line : lines) {
            if (line.comment) continue;
            split_line(line.content, separator, cells, storage);
            if (all++ == 0) first = cells.size();
            ++counts[cells.size()];
        }
        counts.erase(1);
        counts.erase(0);
        int max = 0;
        std::size_t usual = 0;
        for (const auto& [count, times] : counts) {
            if (times > max) usual = count;
            max = std::max(max, times);
        }
        const double share = all > 0 ? static_cast<double>(max) / all : 0;
        constexpr double kMinPlainShare = 0.8, kMinShareGain = 0.05;
        constexpr std::size_t kColumns = 3;
        const auto better = [&](char other) {
            return share_of_numbers(lines, separator) > share_of_numbers(lines, other);
        };
        if (share >= kMinPlainShare && first == usual &&
            (!plain || (usual >= kColumns && separator != ' ' && better(*plain))))
            return separator;
        if (share >= kMinPlainShare && !plain) plain = separator;
        if (share > best_share + kMinShareGain) {
            best = separator;
            best_share = share;
        }
    }
    return plain.value_or(best);
}

CsvLayout pairs_layout(std::string_view text, const ColumnChoices& chosen) {
    CsvLayout layout;
    layout.headings = pair_keys(text, chosen_names(chosen));
    layout.pairs = !layout.headings.empty();
    layout.width = layout.headings.size();
    layout.data_line = 1;
    return layout;
}

// The separator in a first line such as sep=;, which is then removed.
std::optional<char> take_separator(std::vector<Head>& heads) {
    if (heads.empty()) return std::nullopt;
    const auto separator = named_separator(heads.front().content);
    if (separator) heads.erase(heads.begin());
    return separator;
}

// The head of LabVIEW files ends with this line.
void drop_labview_head(std::vector<Head>& heads) {
    for (std::size_t i = heads.size(); i-- > 0;) {
        if (heads[i].content.rfind("***End_of_Header***", 0) != 0) continue;
        heads.erase(heads.begin(), heads.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        return;
    }
}

// A file without other headings may have them in the comments directly above its data.
void find_commented_headings(const std::vector<Head>& heads, std::vector<Head>::const_iterator data,
                             CsvLayout& layout) {
    constexpr int kMaxComments = 3;
    for (int n = 0; n < kMaxComments && layout.headings.empty() && data != heads.begin(); ++n) {
        if (!(--data)->comment) return;
        const auto found = commented_headings(data->number, data->content, layout);
        if (!found) continue;
        take_headings(*found, layout);
        layout.commented = true;
        layout.narrow_heading_line = 0;
    }
}

// If the first lines of a file hold only whole numbers, the rest is examined too.
void find_sign(std::string_view text, const std::vector<CsvLine>& rows, const std::vector<Head>& heads,
               CsvLayout& layout) {
    DecimalSignFinder finder;
    const auto look = [&](const std::vector<std::string_view>& cells) {
        for (std::size_t column = 0; column < cells.size(); ++column) finder.look_at(cells[column], column);
    };
    for (const CsvLine& row : rows) look(row.cells);
    const char* const signs = layout.separator == ',' ? ".\"" : ".,";
    std::size_t at = heads.empty() ? text.size() : heads.back().at;
    std::deque<std::string> storage;
    std::vector<std::string_view> cells;
    while (!finder.certain()) {
        const auto line = next_line(text, at);
        if (!line) break;
        if (line->find_first_of(signs) == line->npos) continue;
        split_line(*line, layout.separator, cells, storage);
        look(cells);
        storage.clear();
    }
    layout.sign = finder.found();
    layout.open_number = finder.open_example();
}

CsvLayout table_layout(std::string_view text) {
    CsvLayout layout;
    std::vector<Head> heads = first_lines(text);
    const auto named = take_separator(heads);
    drop_labview_head(heads);
    layout.separator = named ? *named : find_separator(heads);

    std::vector<CsvLine> lines;
    for (const Head& head : heads) {
        if (head.comment) continue;
        lines.push_back({head.number, {}});
        split_line(head.content, layout.separator, lines.back().cells, layout.unquoted);
        layout.width = std::max(layout.width, lines.back().cells.size());
    }
    if (layout.width > kMaxColumns) return layout;
    layout.lines_of_text = static_cast<int>(lines.size());
    const std::size_t usual = layout.width = usual_width(lines);
    widen_to_headings(lines, layout);
    const auto data = first_data(lines, usual, layout.width);
    const std::vector<CsvLine> rows(data, lines.cend());
    find_headings(filled_lines({lines.cbegin(), data}), rows, layout);
    if (data != lines.cend()) {
        layout.data_line = data->number;
        for (const std::string_view cell : data->cells) layout.first.emplace_back(cell);
        const auto head =
            std::find_if(heads.begin(), heads.end(), [&](const Head& h) { return h.number == data->number; });
        layout.data_at = head->at;
        find_commented_headings(heads, head, layout);
    }
    if (!layout.headings.empty()) layout.width = layout.headings.size();

    find_sign(text, rows, heads, layout);
    return layout;
}

// True for "+------+-----+" and "|---|---|".
bool is_rule(std::string_view content) {
    constexpr std::size_t kShortest = 5;
    return content.size() >= kShortest && content.find_first_not_of("-+=|: ") == content.npos &&
           content.find_first_of("-=") != content.npos;
}

}  // namespace

std::optional<char> named_separator(std::string_view line) {
    constexpr std::string_view prefix = "sep=";
    const std::string_view content = trimmed(line);
    if (lower_case(content.substr(0, prefix.size())) != prefix) return std::nullopt;
    const std::size_t sign = line.find('=') + 1;
    // A letter of several bytes cannot be a separator: half of it would stay in every cell.
    const bool plain = sign < line.size() && line[sign] != '"' && static_cast<unsigned char>(line[sign]) < 0x80;
    return plain ? line[sign] : ',';
}

void split_line(std::string_view line, char separator, std::vector<std::string_view>& cells,
                std::deque<std::string>& storage) {
    cells.clear();
    if (separator == ' ') return split_at_blanks(line, cells, storage);
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

bool is_comment(std::string_view content) {
    if (is_rule(content)) return true;
    return content.front() == '#' || content.front() == '%' || content.substr(0, 2) == "//" ||
           content.substr(0, 2) == "\"#";
}

CsvLayout find_layout(std::string_view text, const ColumnChoices& chosen) {
    CsvLayout table = table_layout(text);
    if (table.width > kMaxColumns) return table;
    const std::vector<std::string_view> headings(table.headings.begin(), table.headings.end());
    // A remark such as "Kp=1 Ki=2" in the rows of a table does not make them a log of pairs.
    if (table.data_line > 0 && roles_named(headings) > 1) return table;
    CsvLayout pairs = pairs_layout(text, chosen);
    return pairs.pairs ? pairs : table;
}

CsvLines::CsvLines(std::string_view text, const CsvLayout& layout)
    : text_(layout.data_line == 0 ? std::string_view() : text),
      layout_(layout),
      at_(layout.data_at),
      number_(layout.data_line - 1) {}

int CsvLines::source_line(int number) const {
    const auto at = static_cast<std::size_t>(number) - 1;
    return at < layout_.source_lines.size() ? layout_.source_lines[at] : number;
}

bool CsvLines::next_pairs(std::string_view content, CsvLine& line) {
    split_pairs(content, pairs_);
    if (!is_pair_line(pairs_, layout_.headings)) return false;
    line.cells.assign(layout_.width, {});
    for (const Pair& pair : pairs_) {
        const auto at = std::find(layout_.headings.begin(), layout_.headings.end(), pair.key);
        if (at == layout_.headings.end()) continue;
        std::string_view& cell = line.cells[static_cast<std::size_t>(at - layout_.headings.begin())];
        if (cell.empty()) cell = pair.value;
    }
    return true;
}

bool CsvLines::next(CsvLine& line) {
    unquoted_.clear();
    while (const auto content = next_line(text_, at_)) {
        ++number_;
        line.number = source_line(number_);
        const std::string_view inner = trimmed(*content);
        if (inner.empty()) continue;
        if (layout_.pairs) {
            if (next_pairs(inner, line)) return true;
            continue;
        }
        if (is_comment(inner)) continue;
        split_line(*content, layout_.separator, line.cells, unquoted_);
        return true;
    }
    return false;
}

}  // namespace tunewright::api
