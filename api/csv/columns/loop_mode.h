// The mode of a loop, row by row: automatic or manual, in the words and codes of historians.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/csv/columns/heading.h"

namespace tunewright::api {

/// True for "AUTO", "CAS", "Automatik", ...: the controller computes u. False for "MAN", "Hand", "TRK", ...: it does
/// not. Empty for another word. Letter case does not count.
std::optional<bool> mode_word(std::string_view word);

/// The meaning of the numbers in a column: true is automatic. "Mode (0=MAN, 1=AUTO)" states it; in "TIC101.AUTO" 1 is
/// automatic, in "TIC101.MAN" 1 is manual. Empty if the heading gives none.
using ModeCodes = std::map<double, bool>;
ModeCodes mode_codes(const Heading& heading);

/// Reads a column of modes, which keep their value until the next one.
class ModeColumn {
public:
    ModeColumn() = default;
    explicit ModeColumn(ModeCodes codes) : codes_(std::move(codes)) {}

    /// A word, a code, or a mark of a missing value, which changes nothing. False for the latter.
    bool see(std::string_view cell);
    /// Adds a row in the mode seen last. An unknown mode counts as manual.
    void add_row();

    /// True in automatic; rows before the first mode have that one. Empty if no word was known.
    std::vector<bool> take();
    /// The sentence that names the unknown words; "" if there are none.
    std::string unknown() const;

private:
    std::optional<bool> read(std::string_view cell) const;

    ModeCodes codes_;
    std::optional<bool> now_;  ///< of the last cell, if its word is known
    bool seen_ = false, known_ = false;
    std::size_t before_ = 0;  ///< rows before the first mode
    std::vector<bool> rows_;
    std::vector<std::string> unknown_words_;
    int unknown_rows_ = 0;
};

}  // namespace tunewright::api
