// Reads a file of many loops line by line, so that a file and a body that arrives in pieces take the same way.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/historian/layouts/loop_table.h"

namespace tunewright::api {

/// 1. The first lines, up to 5,000 or 4 MiB, show the layout (open_table).
/// 2. Each line is then read once, into columns.
/// 3. After the last line the loops are handed out one after the other, and the memory of each is freed.
///
///     LoopsReader reader({});
///     std::string storage;
///     const std::string_view text = utf8_text(bytes, storage);
///     std::size_t at = 0;
///     for (int number = 1; const auto line = next_line(text, at); ++number)
///         if (auto problem = reader.line(number, *line)) ...
///     if (auto problem = reader.finish()) ...
///     TaggedLoop loop;
///     while (reader.next(loop)) ...
class LoopsReader {
public:
    explicit LoopsReader(LoopsOptions options) : options_(std::move(options)) {}

    /// Reads the next line, UTF-8 and without its end; `number` counts from 1. 422 if the file cannot be read or has
    /// too many values; nothing may be read after that. A loop that cannot be read is a fault of that loop.
    std::optional<Problem> line(int number, std::string_view text);
    /// 422 if the file has no loop.
    std::optional<Problem> finish();

    /// False after the last loop.
    bool next(TaggedLoop& loop);

    /// Findings about the whole file; after finish().
    const std::vector<std::string>& notes() const { return notes_; }
    /// Values and times that are kept.
    std::size_t numbers() const { return table_ ? table_->numbers() : 0; }

private:
    std::optional<Problem> open();
    std::optional<Problem> row(int number, const std::vector<std::string_view>& cells);

    LoopsOptions options_;
    std::string head_;
    int head_lines_ = 0;
    std::unique_ptr<LoopTable> table_;
    char separator_ = ',';
    std::size_t width_ = 0;
    std::size_t lines_ = 0, wide_lines_ = 0;  ///< of data; those with more cells than the table has columns
    int first_wide_line_ = 0, first_line_ = 0;
    std::vector<std::string_view> cells_;
    std::deque<std::string> unquoted_;
    std::vector<std::string> notes_;
};

}  // namespace tunewright::api
