#include "api/csv/table.h"

#include <algorithm>
#include <map>

#include "api/csv/columns/heading.h"
#include "api/csv/text_lines.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

constexpr int kLooked = 200;

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
        if (inner[i] == '"') ++i;
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

/// A line above or among the first of the data, with its place in the text.
struct Head {
    int number = 0;
    std::size_t at = 0;
    std::string_view content;
    bool comment = false;
};

std::vector<Head> first_lines(std::string_view text) {
    std::vector<Head> lines;
    std::size_t at = 0, start = 0;
    for (int number = 1; static_cast<int>(lines.size()) < kLooked; ++number) {
        start = at;
        const auto line = next_line(text, at);
        if (!line) break;
        const std::string_view content = trimmed(*line);
        if (content.empty()) continue;
        lines.push_back({number, start, *line, is_comment(content)});
    }
    return lines;
}

// The separator that splits most lines into equally many cells, more than one; those that are never there by chance
// come first.
char find_separator(const std::vector<Head>& lines) {
    char best = ',';
    double best_share = 0;
    std::deque<std::string> storage;
    std::vector<std::string_view> cells;
    for (const char separator : {'\t', ';', '|', ',', ' '}) {
        std::map<std::size_t, int> counts;
        int all = 0;
        for (const Head& line : lines) {
            if (line.comment) continue;
            split_line(line.content, separator, cells, storage);
            ++counts[cells.size()];
            ++all;
        }
        counts.erase(1);
        counts.erase(0);
        int most = 0;
        for (const auto& [count, times] : counts) most = std::max(most, times);
        const double share = all > 0 ? static_cast<double>(most) / all : 0;
        constexpr double kPlain = 0.8, kBetter = 0.05;
        if (share >= kPlain) return separator;
        if (share > best_share + kBetter) {
            best = separator;
            best_share = share;
        }
    }
    return best;
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
    int most = 0;
    for (const auto& [count, times] : counts) {
        if (times < most) continue;
        width = count;
        most = times;
    }
    return width;
}

bool holds_data(std::string_view cell) {
    double number = 0;
    return read_cell_number(cell, number, DecimalSign::either, unit_suffix(cell)) || read_time_stamp(cell).has_value();
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

int roles_named(const std::vector<std::string_view>& cells) {
    int named = 0;
    for (const std::string_view cell : cells) {
        const Heading heading = split_heading(cell);
        for (const Role role : {kTimeRole, kInputRole, kOutputRole, kReferenceRole}) {
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
    for (const std::string_view cell : line.cells) layout.headings.emplace_back(cell);
}

// A heading for each column but the first, which counts the rows: what R writes.
bool counts_rows(const std::vector<CsvLine>& data) {
    constexpr std::size_t kFew = 5;
    double before = 0;
    for (std::size_t i = 0; i < std::min(data.size(), kFew); ++i) {
        double number = 0;
        if (!read_cell_number(data[i].cells.front(), number) || (i > 0 && number != before + 1)) return false;
        before = number;
    }
    return data.size() > 1;
}

// Which of the lines of text, as wide as the data and right above it, holds the headings: the others are a title, units
// or descriptions.
std::size_t heading_among(const std::vector<CsvLine>& above, std::size_t first) {
    std::size_t best = first, most = 0;
    int named = 0;
    for (std::size_t i = first; i < above.size(); ++i) most = std::max(most, filled(above[i].cells));
    while (best + 1 < above.size() && 2 * filled(above[best].cells) <= most) ++best;
    for (std::size_t i = best; i < above.size(); ++i) {
        const int now = roles_named(above[i].cells);
        if (now <= named) continue;
        named = now;
        best = i;
    }
    return best;
}

// The lines of text right above the data that are as wide as it is.
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
    layout.below.assign(above.begin() + static_cast<std::ptrdiff_t>(at) + 1, above.end());
    if (above[at].cells.size() + 1 != layout.width || !counts_rows(data) || data.front().cells.back().empty()) return;
    layout.numbered = true;
    layout.headings.insert(layout.headings.begin(), "");
}

// "# t,u,y" and "#,Time,PV": the heading line of those who write headings as comments, or number their rows. Blanks
// part the words of any sentence too, so one of them must name a role.
std::optional<CsvLine> commented_headings(const Head& line, CsvLayout& layout) {
    const std::string_view whole = trimmed(line.content);
    for (const std::string_view content :
         {trimmed(whole.substr(std::min(whole.find_first_not_of("#/%"), whole.size()))), whole}) {
        for (const char separator : {layout.separator, ',', ';', '\t', '|', ' '}) {
            CsvLine cells{line.number, {}};
            split_line(content, separator, cells.cells, layout.unquoted);
            while (!cells.cells.empty() && cells.cells.back().empty() && cells.cells.size() > layout.width)
                cells.cells.pop_back();
            if (layout.width < 2 || cells.cells.size() != layout.width || !is_text(cells)) continue;
            if ((separator == layout.separator && separator != ' ') || roles_named(cells.cells) > 0) return cells;
        }
    }
    return std::nullopt;
}

// Rows that end where their last value is: the headings and the longest rows tell how many columns there are.
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

CsvLayout pairs_layout(std::string_view text) {
    CsvLayout layout;
    layout.headings = pair_keys(text);
    layout.pairs = !layout.headings.empty();
    layout.width = layout.headings.size();
    layout.data_line = 1;
    return layout;
}

// The separator that a first line such as sep=; tells, which is then taken off.
std::optional<char> told_separator(std::vector<Head>& heads) {
    constexpr std::string_view kToldPrefix = "sep=";
    if (heads.empty() || lower_case(trimmed(heads.front().content)).rfind(kToldPrefix, 0) != 0) return std::nullopt;
    const std::string_view line = heads.front().content;
    const std::size_t sign = line.find('=') + 1;
    const char separator = sign < line.size() && line[sign] != '"' ? line[sign] : ',';
    heads.erase(heads.begin());
    return separator;
}

// LabVIEW's files end their head with this line.
void drop_labview_head(std::vector<Head>& heads) {
    for (std::size_t i = heads.size(); i-- > 0;) {
        if (heads[i].content.rfind("***End_of_Header***", 0) != 0) continue;
        heads.erase(heads.begin(), heads.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        return;
    }
}

// The headings in the comments right above the data, where there are no others.
void find_commented_headings(const std::vector<Head>& heads, std::vector<Head>::const_iterator data,
                             CsvLayout& layout) {
    constexpr int kMostComments = 3;
    for (int n = 0; n < kMostComments && layout.headings.empty() && data != heads.begin(); ++n) {
        if (!(--data)->comment) return;
        const auto found = commented_headings(*data, layout);
        if (!found) continue;
        take_headings(*found, layout);
        layout.commented = true;
        layout.narrow_heading_line = 0;
    }
}

CsvLayout table_layout(std::string_view text) {
    CsvLayout layout;
    std::vector<Head> heads = first_lines(text);
    const auto told = told_separator(heads);
    drop_labview_head(heads);
    layout.separator = told ? *told : find_separator(heads);

    std::vector<CsvLine> lines;
    for (const Head& head : heads) {
        if (head.comment) continue;
        lines.push_back({head.number, {}});
        split_line(head.content, layout.separator, lines.back().cells, layout.unquoted);
    }
    layout.lines_of_text = static_cast<int>(lines.size());
    const std::size_t usual = layout.width = usual_width(lines);
    widen_to_headings(lines, layout);
    const auto data = std::find_if(lines.begin(), lines.end(),
                                   [&](const CsvLine& line) { return is_data_of(line, usual, layout.width); });
    const std::vector<CsvLine> rows(data, lines.end());
    find_headings({lines.begin(), data}, rows, layout);
    if (data != lines.end()) {
        layout.data_line = data->number;
        for (const std::string_view cell : data->cells) layout.first.emplace_back(cell);
        const auto head =
            std::find_if(heads.begin(), heads.end(), [&](const Head& h) { return h.number == data->number; });
        layout.data_at = head->at;
        find_commented_headings(heads, head, layout);
    }
    if (!layout.headings.empty()) layout.width = layout.headings.size();

    DecimalSignFinder finder;
    for (const CsvLine& row : rows) {
        for (const std::string_view cell : row.cells) finder.look_at(cell);
    }
    layout.sign = finder.found();
    return layout;
}

// "+------+-----+" and "|---|---|".
bool is_rule(std::string_view content) {
    constexpr std::size_t kShortest = 5;
    return content.size() >= kShortest && content.find_first_not_of("-+=|: ") == content.npos &&
           content.find_first_of("-=") != content.npos;
}

}  // namespace

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

CsvLayout find_layout(std::string_view text) {
    CsvLayout table = table_layout(text);
    const std::vector<std::string_view> headings(table.headings.begin(), table.headings.end());
    // A remark such as "Kp=1 Ki=2" in the rows of a table makes them no log of pairs.
    if (table.data_line > 0 && roles_named(headings) > 1) return table;
    CsvLayout pairs = pairs_layout(text);
    return pairs.pairs ? pairs : table;
}

CsvLines::CsvLines(std::string_view text, const CsvLayout& layout)
    : text_(layout.data_line == 0 ? std::string_view() : text),
      layout_(layout),
      at_(layout.data_at),
      number_(layout.data_line - 1) {}

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
        line.number = number_;
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
