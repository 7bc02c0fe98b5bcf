// CSV text as lines of cells: separator, quotes, preamble, headings. Knows nothing of records.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/cell.h"

namespace tunewright::api {

struct CsvLine {
    int number = 0;                       ///< in the file, from 1
    std::vector<std::string_view> cells;  ///< trimmed, without quotes
};

/// What the first lines say about the file.
struct CsvLayout {
    char separator = ',';               ///< ' ' for runs of blanks
    std::vector<std::string> headings;  ///< empty if the file has none
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
    std::deque<std::string> unquoted;  ///< storage of cells that held doubled quotes
};

/// Separators , ; tab | and blanks, found by the first 200 lines, or told by a first line such as sep=;. Blank lines,
/// comments (# and //) and what a logger writes above the headings are skipped.
/// The headings are the first line of text as wide as the data, in the lines right above it; a comment of that width
/// is a heading line too. `text` must outlive what is returned.
CsvLayout find_layout(std::string_view text);

/// The cells of one line, trimmed and without quotes; those that held doubled quotes live in `storage`.
void split_line(std::string_view line, char separator, std::vector<std::string_view>& cells,
                std::deque<std::string>& storage);

/// What people write beside the data: a line that begins with # or //. `content` is trimmed and not empty.
bool is_comment(std::string_view content);

/// The lines of data, one after another, without keeping them.
class CsvLines {
public:
    CsvLines(std::string_view text, const CsvLayout& layout);

    /// False at the end. The cells are valid until the next call. Blank lines and comments are skipped.
    bool next(CsvLine& line);

private:
    std::string_view text_;
    char separator_;
    std::size_t at_;
    int number_;
    std::deque<std::string> unquoted_;
};

}  // namespace tunewright::api
