// CSV text as lines of cells: separator, quotes, preamble, headings. Knows nothing of records.
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

/// What the first lines say about the file.
struct CsvLayout {
    char separator = ',';               ///< ' ' for runs of blanks
    std::vector<std::string> headings;  ///< empty if the file has none
    std::vector<std::string> surplus;   ///< headings behind the last column that has values
    bool pairs = false;                 ///< lines that name each value (pairs.h); headings are the names
    bool commented = false;             ///< the headings are a comment
    bool numbered = false;              ///< the rows begin with a number for which there is no heading
    std::vector<std::string> first;     ///< cells of the first line of data
    std::vector<CsvLine> below;         ///< lines of units or descriptions between the headings and the data
    int heading_line = 0;               ///< 0: none
    std::size_t data_at = 0;            ///< offset of the first line of data
    int data_line = 0;                  ///< its number; 0: there is none
    std::size_t width = 0;              ///< cells of a line
    int lines_of_text = 0;              ///< looked at that are neither comment nor blank
    int narrow_heading_line = 0;        ///< a line of text right above the data that is not as wide; 0: none
    std::size_t narrow_heading_cells = 0;
    int skipped = 0;  ///< lines before the headings that are neither comment nor blank
    DecimalSign sign = DecimalSign::either;
    std::string open_number = {};      ///< the first that is three decimals or a thousand, as `sign` has it; "": none
    bool pivoted = false;              ///< a blank cell is a value that another time has (shape/pivot.h)
    std::vector<int> source_lines;     ///< of each line of the text, the file's line; empty: the same
    std::deque<std::string> unquoted;  ///< storage of cells that held doubled quotes
};

/// Separators , ; tab | and blanks, found by the first 200 lines, or named by a first line such as sep=;. Blank lines,
/// comments (#, % and //) and what a logger writes above the headings are skipped.
/// The headings are a line of text as wide as the data, in the lines right above it: the one that names most roles,
/// else the first; a comment of that width is a heading line too. Of a log of pairs (pairs.h) they are its names.
/// In a log with lines of several kinds, those with the `chosen` columns are read (pairs.h). Of a file whose first
/// lines have more than kMaxColumns cells, only that width is found.
/// `text` must outlive what is returned.
CsvLayout find_layout(std::string_view text, const ColumnChoices& chosen);

/// The separator that a line such as sep=; names, as spreadsheets write it first; a comma where it names none that a
/// byte can be. Nothing where the line is another.
std::optional<char> named_separator(std::string_view line);

/// The cells of one line, trimmed and without quotes; those that held doubled quotes live in `storage`.
void split_line(std::string_view line, char separator, std::vector<std::string_view>& cells,
                std::deque<std::string>& storage);

/// What people write beside the data: a line that begins with #, % or //, and the lines that a table is drawn with.
/// `content` is trimmed and not empty.
bool is_comment(std::string_view content);

/// The lines of data, one after another, without keeping them.
class CsvLines {
public:
    /// `layout` must outlive it.
    CsvLines(std::string_view text, const CsvLayout& layout);

    /// False at the end. The cells are valid until the next call. Blank lines, comments, and what a log of pairs holds
    /// beside them are skipped.
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
