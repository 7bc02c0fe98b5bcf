// CSV text as lines of cells: separator, quotes, preamble, headings. Independent of records.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/column_choice.h"
#include "api/csv/pairs.h"

namespace tunewright::api {

struct CsvLine {
    int number = 0;                       ///< in the file, from 1
    std::vector<std::string_view> cells;  ///< trimmed, without quotes
};

/// Layout of the file, from its first lines.
struct CsvLayout {
    char separator = ',';               ///< ' ' for runs of blanks
    std::vector<std::string> headings;  ///< empty: the file has none
    std::vector<std::string> surplus;   ///< headings behind the last column that has values
    bool pairs = false;                 ///< lines that name each value (pairs.h); headings are the names
    bool commented = false;             ///< the headings are a comment
    bool numbered = false;              ///< the rows begin with a number that has no heading
    std::vector<std::string> first;     ///< cells of the first line of data
    std::vector<CsvLine> below;         ///< lines of units or descriptions between the headings and the data
    int heading_line = 0;               ///< 0: none
    std::size_t data_at = 0;            ///< offset of the first line of data
    int data_line = 0;                  ///< number of the first line of data; 0: there is none
    std::size_t width = 0;              ///< number of cells in a line
    int lines_of_text = 0;              ///< examined lines that are neither comment nor blank
    int narrow_heading_line = 0;        ///< a line of text right above the data with fewer cells; 0: none
    std::size_t narrow_heading_cells = 0;
    int skipped = 0;  ///< lines before the headings that are neither comment nor blank
    DecimalSign sign = DecimalSign::either;
    std::string open_number = {};      ///< the first number that is ambiguous between three decimals and a thousand,
                                       ///< read by `sign`; "": none
    bool pivoted = false;              ///< a blank cell is a value that exists only at another time (shape/pivot.h)
    std::vector<int> source_lines;     ///< for each line of the text, the line of the file; empty: the same
    std::deque<std::string> unquoted;  ///< storage of cells with doubled quotes
};

/// Separators , ; tab | and blanks, found by the first 200 lines, or named by a first line such as sep=;. Blank lines,
/// comments (#, % and //) and a logger's lines above the headings are skipped. The headings are a line of text as wide
/// as the data, in the lines right above it: the one that names most roles, else the first; a comment of that width is
/// a heading line too. In a log of pairs (pairs.h) the headings are its names. In a log with lines of several kinds,
/// those with the `chosen` columns are read (pairs.h). If the first lines have more than kMaxColumns cells, only the
/// width is found. `text` must outlive the result.
CsvLayout find_layout(std::string_view text, const ColumnChoices& chosen);

/// The separator that a line such as sep=; names, the first line of some spreadsheets; a comma if it names one of more
/// than a byte. Empty for another line.
std::optional<char> named_separator(std::string_view line);

/// Splits one line into cells, trimmed and without quotes; cells with doubled quotes are stored in `storage`.
void split_line(std::string_view line, char separator, std::vector<std::string_view>& cells,
                std::deque<std::string>& storage);

/// True for a line next to the data that is not data: one that begins with #, % or //, or a line drawn around a table.
/// `content` is trimmed and not empty.
bool is_comment(std::string_view content);

/// Reads the lines of data one after another, without storing them.
class CsvLines {
public:
    /// `layout` must outlive it.
    CsvLines(std::string_view text, const CsvLayout& layout);

    /// False at the end. The cells are valid until the next call. Blank lines, comments, and lines of a log that hold
    /// no pairs are skipped.
    bool next(CsvLine& line);

private:
    bool next_pairs(std::string_view content, CsvLine& line);

    int source_line(int number) const;

    std::string_view text_;
    const CsvLayout& layout_;
    std::size_t at_;
    int number_;
    std::vector<Pair> pairs_;
    std::deque<std::string> unquoted_;
};

}  // namespace tunewright::api
