#include "api/historian/loops_reader.h"

#include <algorithm>
#include <utility>

#include "api/csv/columns/column_profile.h"
#include "api/historian/tags/loop_tags.h"
#include "api/historian/tags/tag_lines.h"

namespace tunewright::api {
namespace {

constexpr int kHeadLines = kProfiledLines;
constexpr std::size_t kHeadBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxUnreadShare = 50;  ///< one line in so many may be unreadable without a word about it

std::string too_many_numbers(std::size_t max) {
    constexpr std::size_t kMillion = 1'000'000;
    return "The file has more than " +
           (max >= kMillion ? std::to_string(max / kMillion) + " million" : std::to_string(max)) +
           " values and times. Send it in parts, with fewer loops or a shorter time in each, or export fewer rows.";
}

}  // namespace

std::optional<Problem> LoopsReader::line(int number, std::string_view text) {
    if (!table_) {
        head_.append(text).append("\n");
        if (++head_lines_ < kHeadLines && head_.size() < kHeadBytes) return std::nullopt;
        return open();
    }
    const std::string_view content = trimmed(text);
    if (content.empty() || is_comment(content)) return std::nullopt;
    unquoted_.clear();
    split_line(text, separator_, cells_, unquoted_);
    return row(number, cells_);
}

std::optional<Problem> LoopsReader::open() {
    CsvLayout layout = find_layout(head_, {});
    begin_below_tag_headings(head_, options_.named_by_file && split_tag(options_.name).role, layout);
    auto table = open_table(head_, layout, options_, notes_);
    if (auto* problem = std::get_if<Problem>(&table)) return std::move(*problem);
    table_ = std::get<std::unique_ptr<LoopTable>>(std::move(table));
    separator_ = layout.separator;
    width_ = layout.width;
    CsvLines lines(head_, layout);
    CsvLine line;
    while (lines.next(line))
        if (auto problem = row(line.number, line.cells)) return problem;
    head_ = {};
    return std::nullopt;
}

std::optional<Problem> LoopsReader::row(int number, const std::vector<std::string_view>& cells) {
    if (lines_++ == 0) first_line_ = number;
    const auto beyond = cells.begin() + static_cast<std::ptrdiff_t>(std::min(cells.size(), width_));
    if (std::any_of(beyond, cells.end(), [](std::string_view cell) { return !cell.empty(); })) {
        if (wide_lines_++ == 0) first_wide_line_ = number;
        return std::nullopt;
    }
    table_->row(number, cells);
    if (auto fault = table_->fault(); !fault.empty()) return unreadable_loops(std::move(fault));
    if (table_->numbers() > options_.max_numbers) return unreadable_loops(too_many_numbers(options_.max_numbers));
    return std::nullopt;
}

std::optional<Problem> LoopsReader::finish() {
    if (!table_)
        if (auto problem = open()) return problem;
    if (table_->rows() == 0 && wide_lines_ > 0)
        return unreadable_loops("Line " + std::to_string(first_wide_line_) +
                                " has more cells than headings. Numbers with "
                                "a decimal comma need ; or tab as separator, or quotes.");
    if (table_->rows() == 0)
        return unreadable_loops("No line has a time that can be read; line " + std::to_string(first_line_) +
                                " is the first without one.");
    for (std::string& note : table_->notes()) notes_.push_back(std::move(note));
    if (wide_lines_ * kMaxUnreadShare > lines_)
        notes_.push_back(std::to_string(wide_lines_) + (wide_lines_ == 1 ? " line has" : " lines have") +
                         " more cells than headings and " + (wide_lines_ == 1 ? "was" : "were") +
                         " left out; the first is line " + std::to_string(first_wide_line_) + ".");
    return std::nullopt;
}

bool LoopsReader::next(TaggedLoop& loop) { return table_ && table_->next(loop); }

}  // namespace tunewright::api
