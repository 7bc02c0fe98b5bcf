// One cell of an export as a number, or as the mark of a value that is not there.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

/// What . and , mean in a file's numbers.
enum class DecimalSign {
    point,   ///< 1,234.5
    comma,   ///< 1.234,5
    either,  ///< a lone . or , is the decimal sign: the file shows both, or neither plainly
};

/// Reads the evidence of the cells: "20,25" needs a decimal comma, "0.5" a point, "1,234" may be either; in a column of
/// whole numbers up to 999 it is a thousand.
class DecimalSignFinder {
public:
    void look_at(std::string_view cell, std::size_t column);
    DecimalSign found() const;
    /// Whether a cell showed it; what columns show is seen at the end.
    bool certain() const { return point_ || comma_; }
    /// The first cell that may be either, where no cell is certain; "" if there is none.
    std::string open_example() const { return certain() ? "" : open_; }

private:
    struct Column {
        bool points = false, commas = false;       ///< cells that may be either
        bool hundreds = false, thousands = false;  ///< whole numbers without a sign: 100 to 999, and beyond
        bool of_groups() const { return points != commas && hundreds && !thousands; }
    };

    bool point_ = false, comma_ = false;
    std::vector<Column> columns_;
    std::string open_;
};

/// A number with decimal sign, grouped thousands (by . , ' or a blank) and the unit `suffix` behind it, if that is not
/// empty; false for any other text: blank, NaN and Infinity included.
bool read_cell_number(std::string_view cell, double& value, DecimalSign sign = DecimalSign::either,
                      std::string_view suffix = {});

/// What follows the number in "25.3 degC": "degC"; "" where it is a plain number or none.
std::string_view unit_suffix(std::string_view cell);

/// Blank, NaN, NA, null, -, the errors of spreadsheets and what historians write for a value that they do not have
/// ("Bad Input", "No Data", "I/O Timeout").
bool is_missing(std::string_view cell);

/// ON, open, true, running: 1; off, closed, false, stopped: 0, in several languages. Empty for any other text.
std::optional<double> switch_word(std::string_view cell);

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

}  // namespace tunewright::api
