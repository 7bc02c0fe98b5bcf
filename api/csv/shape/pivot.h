// Values that each have a time and a tag, as a table with a column for each tag.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/csv/time_stamp.h"

namespace tunewright::api {

/// A table in place of a file.
struct ShapedText {
    std::string text;                ///< headings in the first line, cells in quotes, separated by commas
    std::vector<int> lines;          ///< of each of its lines, the line of the file that it comes from, from 1
    bool pivoted = false;            ///< blank cells are values that other times have
    std::vector<std::string> notes;  ///< what was found, one sentence each
    std::string fault = {};          ///< why the file cannot be made into a table; then there is no text
    std::string fault_at = "csv";    ///< as CsvFault::where
    std::size_t cells = 0;
};

/// Limits of a table that is made from a file: every name in it adds a column, and every column a cell to all rows.
inline constexpr std::size_t kMaxTableCells = 50'000'000;

/// Adds a line to the table, each cell with a value in quotes. A table of more than kMaxTableCells has a fault, and no
/// line is added any more.
void add_line(ShapedText& table, const std::vector<std::string_view>& cells, int line);

/// The sentence that refuses a file of so many, above kMaxColumns.
std::string too_many_columns(std::size_t columns);

class Pivot {
public:
    static constexpr std::size_t kMaxTags = 500;

    /// Values arrive in the order of the file. A time is a number or a stamp (time_stamp.h); a value without one is
    /// left out. False where there would be more than kMaxTags tags: the value is left out.
    bool add(std::string_view time, std::string_view tag, std::string_view value, int line);

    const std::vector<std::string>& tags() const { return tags_; }

    /// A row for each time, ascending, with the value of each tag where it has one then, else blank. Of several values
    /// of a tag at one time each has a row. `time_heading` is that of the first column.
    ShapedText table(std::string_view time_heading) const;

private:
    struct Entry {
        double key[2];  ///< s, or the number as it is; with the day or the month first
        std::string time, value;
        std::size_t tag;
        int line;
    };

    std::optional<std::size_t> tag_index(std::string_view tag);

    std::vector<std::string> tags_;
    std::unordered_map<std::string, std::size_t> places_;  ///< of tags_
    std::vector<Entry> entries_;
};

}  // namespace tunewright::api
