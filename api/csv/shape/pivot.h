// Collects values that each have a time and a tag into a table with a column for each tag.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/csv/time_stamp.h"

namespace tunewright::api {

/// A table made from a file.
struct ShapedText {
    std::string text;                ///< headings in the first line, cells in quotes, separated by commas
    std::vector<int> lines;          ///< for each line of the table, the line of the file from which it comes, from 1
    bool pivoted = false;            ///< blank cells: values that exist only at other times
    std::vector<std::string> notes;  ///< findings, one sentence each
    std::string fault = {};          ///< reason why the file cannot be made into a table; there is then no text
    std::string fault_at = "csv";    ///< as CsvFault::where
    std::size_t cells = 0;
};

/// Limits of a table that is made from a file: every name in it adds a column, and every column a cell to all rows.
inline constexpr std::size_t kMaxTableCells = 50'000'000;

/// Adds a line to the table; cells with a value are quoted. A table of more than kMaxTableCells has a fault, and no
/// further line is added.
void add_line(ShapedText& table, const std::vector<std::string_view>& cells, int line);

/// The sentence that refuses a file with this number of columns, above kMaxColumns.
std::string too_many_columns(std::size_t columns);

class Pivot {
public:
    static constexpr std::size_t kMaxTags = 500;

    /// Adds a value, in the order of the file. A time is a number or a stamp (time_stamp.h); a value without one is
    /// left out. False if there would be more than kMaxTags tags: the value is left out.
    bool add(std::string_view time, std::string_view tag, std::string_view value, int line);

    const std::vector<std::string>& tags() const { return tags_; }

    /// A row for each time, ascending, with the value of each tag at that time, else blank. Several values of a tag at
    /// one time each have a row. `time_heading` is that of the first column.
    ShapedText table(std::string_view time_heading) const;

private:
    struct Entry {
        double key[2];  ///< s, or the number itself; with the day first and with the month first
        std::string time, value;
        std::size_t tag;
        int line;
    };

    std::optional<std::size_t> tag_index(std::string_view tag);

    std::vector<std::string> tags_;
    std::unordered_map<std::string, std::size_t> places_;  ///< index in tags_
    std::vector<Entry> entries_;
};

}  // namespace tunewright::api
