// CSV text as lines of cells: separator, quotes, headings. Knows nothing of records.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

struct CsvTable {
    struct Line {
        int number = 0;                       ///< in the file, from 1
        std::vector<std::string_view> cells;  ///< trimmed, without quotes
    };

    char separator = ',';
    std::vector<std::string> headings;  ///< empty if the first line holds data
    Line units;                         ///< the line below the headings, where it holds no data; number 0: none
    std::vector<Line> lines;
    std::deque<std::string> unquoted;  ///< storage of cells that held doubled quotes

    CsvTable() = default;
    CsvTable(const CsvTable&) = delete;  // cells look into `unquoted`
    CsvTable& operator=(const CsvTable&) = delete;
    CsvTable(CsvTable&&) = default;
    CsvTable& operator=(CsvTable&&) = default;
};

/// Separators , ; and tab, found by the first lines; blank lines and lines that start with # are skipped; a byte order
/// mark is too. The cells look into `text`, which must outlive the table. Cells in quotes may hold separators, but no
/// line breaks.
CsvTable read_table(std::string_view text);

/// A number with decimal point or comma; false for any other text (blank, NaN and Infinity included).
bool read_cell_number(std::string_view cell, double& value);

/// Blank, NaN, NA, null, - and what spreadsheets write for an error: a sample that is not there.
bool is_missing(std::string_view cell);

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

}  // namespace tunewright::api
