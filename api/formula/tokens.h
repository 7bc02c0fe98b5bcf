// The tokens of the notation: words and signs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/expected.h"

namespace tunewright::api::notation {

enum class NotationToken {
    number,
    symbol,
    function,  ///< min, max, exp, sqrt, with a bracket after it
    big,       ///< int, sum, with its lower limit: sum_k
    word,
    sign,
    line_end,
    label_end
};

struct FormulaToken {
    NotationToken kind = NotationToken::sign;
    std::string text;
    std::size_t position = 1;  ///< of its first character, from 1

    bool is(std::string_view sign) const { return kind == NotationToken::sign && text == sign; }
    bool is_relation() const { return is("=") || is("<") || is(">") || is("<=") || is(">="); }
};

/// The letter for a lower-case name of a Greek letter that formulas use; "" if `name` is none.
std::string_view greek_letter(std::string_view name);

/// Errors: a character that the notation does not have.
Expected<std::vector<FormulaToken>> formula_tokens(std::string_view text);

}  // namespace tunewright::api::notation
