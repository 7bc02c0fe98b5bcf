#include "api/historian/tags/tag_lines.h"

#include <algorithm>

#include "api/csv/columns/heading.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"
#include "api/historian/tags/loop_tags.h"

namespace tunewright::api {
namespace {

/// True if the cells name a tag, a value and a time; of a file of `one_tag` a value and a time.
bool are_tag_headings(const std::vector<std::string_view>& cells, bool one_tag) {
    bool tag = one_tag, value = false, time = false;
    for (const std::string_view cell : cells) {
        const Heading heading = split_heading(cell);
        tag = tag || is_tag_heading(heading.name);
        value = value || is_value_heading(heading.name);
        const auto named = match(heading, kTimeRole);
        time = time || (named && named->level <= 2);
    }
    return tag && value && time;
}

/// The layout that begins with such a line among the first ones.
std::optional<CsvLayout> layout_of_headings(std::string_view head, bool one_tag) {
    constexpr int kMaxLinesAbove = 20;
    std::size_t at = 0;
    std::vector<std::string_view> cells;
    std::deque<std::string> storage;
    for (int number = 1; number <= kMaxLinesAbove; ++number) {
        const auto line = next_line(head, at);
        if (!line) return std::nullopt;
        for (const char separator : {'\t', ';', '|', ','}) {
            split_line(*line, separator, cells, storage);
            if (!are_tag_headings(cells, one_tag)) continue;
            CsvLayout layout;
            layout.separator = separator;
            layout.headings.assign(cells.begin(), cells.end());
            layout.width = cells.size();
            layout.heading_line = number;
            layout.data_at = at;
            layout.data_line = at < head.size() ? number + 1 : 0;
            return layout;
        }
    }
    return std::nullopt;
}

/// The layout of lines that are a time stamp and a word, such as a mode, without headings.
std::optional<CsvLayout> layout_of_words(std::string_view head) {
    constexpr std::size_t kMaxCells = 4;  // date, time of day, value, quality
    std::size_t at = 0;
    const auto line = next_line(head, at);
    std::vector<std::string_view> cells;
    std::deque<std::string> storage;
    for (const char separator : {'\t', ';', '|', ','}) {
        if (!line) break;
        split_line(*line, separator, cells, storage);
        if (cells.size() < 2 || cells.size() > kMaxCells || !read_time_stamp(cells.front())) continue;
        CsvLayout layout;
        layout.separator = separator;
        layout.width = cells.size();
        layout.data_line = 1;
        return layout;
    }
    return std::nullopt;
}

/// The lowest rank of a tag of the first lines, joined from these columns, that names a loop and its part; empty if
/// none does. A description such as "Feed flow" has a higher rank than "FIC101.PV".
std::optional<int> rank_of(std::string_view head, const CsvLayout& layout, const LongColumns& columns) {
    constexpr int kProbedTags = 500;
    CsvLines lines(head, layout);
    CsvLine line;
    std::optional<int> rank;
    for (int n = 0; n < kProbedTags && lines.next(line); ++n) {
        const TagName name = split_tag(long_tag(line.cells, columns));
        if (name.role && !name.key.empty()) rank = std::min(rank.value_or(name.order), name.order);
    }
    return rank;
}

}  // namespace

void begin_below_tag_headings(std::string_view head, bool one_tag, CsvLayout& layout) {
    auto named = layout_of_headings(head, one_tag);
    if (!named && one_tag && layout.data_line == 0) {
        if (auto words = layout_of_words(head)) layout = *std::move(words);
        return;
    }
    if (!named || layout.pairs) return;
    if (named->separator == layout.separator) named->sign = layout.sign;
    const bool later = named->data_line > 0 && (layout.data_line == 0 || layout.data_line > named->data_line);
    if (later && (layout.headings.empty() || layout.headings == named->headings)) layout = *std::move(named);
}

std::optional<LongColumns> find_tag_lines(std::string_view head, const CsvLayout& layout) {
    auto found = find_long_columns(head, layout, true);
    if (!found || found->tags.size() < 2) return found;
    const std::vector<std::size_t> all = found->tags;
    std::vector<std::vector<std::size_t>> choices;
    for (const std::size_t column : all) choices.push_back({column});
    for (std::size_t n = 2; n <= all.size(); ++n)
        choices.emplace_back(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
    std::optional<int> lowest;
    std::vector<std::size_t> best = all;
    for (const std::vector<std::size_t>& choice : choices) {
        found->tags = choice;
        const auto rank = rank_of(head, layout, *found);
        if (!rank || (lowest && *lowest <= *rank)) continue;
        lowest = rank;
        best = choice;
    }
    found->tags = std::move(best);
    return found;
}

}  // namespace tunewright::api
