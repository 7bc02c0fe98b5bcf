// One cell of an export, read as a number or as the mark of a missing value.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

/// The meaning of . and , in a file's numbers.
enum class DecimalSign {
    point,   ///< 1,234.5
    comma,   ///< 1.234,5
    either,  ///< a single . or , is the decimal sign: the file shows both, or neither clearly
};

/// Finds the decimal sign from the cells: "20,25" needs a decimal comma, "0.5" a point, "1,234" may be either; in a
/// column of whole numbers up to 999 it is a thousand.
class DecimalSignFinder {
public:
    void look_at(std::string_view cell, std::size_t column);
    DecimalSign found() const;
    /// True if a cell is unambiguous; evidence from whole columns is used only at the end.
    bool certain() const { return point_ || comma_; }
    /// The first ambiguous cell, if no cell is certain; "" if there is none.
    std::string open_example() const { return certain() ? "" : open_; }

private:
    struct Column {
        bool points = false, commas = false;       ///< cells that are ambiguous
        bool hundreds = false, thousands = false;  ///< whole numbers without a sign: 100 to 999, and beyond
        bool of_groups() const { return points != commas && hundreds && !thousands; }
    };

    bool point_ = false, comma_ = false;
    std::vector<Column> columns_;
    std::string open_;
};

/// Reads a number with decimal sign, grouped thousands (by . , ' or a blank) and, if `suffix` is not empty, that unit
/// behind it; false for any other text, including blank, NaN and Infinity.
bool read_cell_number(std::string_view cell, double& value, DecimalSign sign = DecimalSign::either,
                      std::string_view suffix = {});

/// The text behind the number: "degC" of "25.3 degC"; "" for a plain number or another text.
std::string_view unit_suffix(std::string_view cell);

/// True for a blank cell, NaN, NA, null, -, the errors of spreadsheets and the marks of historians for a missing value
/// ("Bad Input", "No Data", "I/O Timeout").
bool is_missing(std::string_view cell);

/// 1 for ON, open, true, running; 0 for off, closed, false, stopped; in several languages. Empty for any other text.
std::optional<double> switch_word(std::string_view cell);

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

}  // namespace tunewright::api
