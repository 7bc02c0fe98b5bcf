// The words and signs of the notation, told apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/expected.h"

namespace tunewright::api::notation {

enum class NotationToken {
    number,
    symbol,
    function,  ///< min, max, exp, sqrt, with a bracket behind it
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

/// Lower-case names of Greek letters that formulas use, each with its letter; "" where `name` is none.
std::string_view greek_letter(std::string_view name);

/// Errors: a character that the notation has no use for.
Expected<std::vector<FormulaToken>> formula_tokens(std::string_view text);

}  // namespace tunewright::api::notation
