// The plain-text notation in which the registry states the formulas of tuning methods, read into a tree, and written as
// MathML.
//
//     PI: Kp = 2 T/(3 K L), Ti = T; PID: Kp = 2 (T1 + T2)/(3 K L), Ti = T1 + T2
//
// "; " and ". " end a line. The text before the last ": " of a line is its label. ", " ends a cell if there is an
// equation on either side of it. Products are written without a sign and have the precedence of a slash, from left to
// right: a b/c d is (a b/c) d. Powers have ^, magnitudes |x|, indices _ or digits; min, max, exp and sqrt are functions
// if a bracket follows; int and sum are signs with limits (int_0^H). A single letter, a Greek name or one of the
// field's pairs of letters (Kp, Ti, Ku, ...) is a symbol; other names are words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/expected.h"

namespace tunewright::api::notation {

enum class Part {
    number,    ///< text
    symbol,    ///< text: Kp, tau_c, T1
    sign,      ///< text: + - = < > <= >= ! ,
    words,     ///< text
    row,       ///< parts side by side: signs and terms
    product,   ///< parts: factors
    fraction,  ///< parts: above, below
    power,     ///< parts: base, exponent
    brackets,  ///< text: ( or [; parts: what is inside
    bars,      ///< parts: what is inside
    apply,     ///< text: the function; parts: its brackets or bars
    big,       ///< text: int or sum; parts: nothing, the lower limit, or both limits
};

struct Node {
    Part part = Part::row;
    std::string text = {};
    std::vector<Node> parts = {};
};

using Cell = std::vector<Node>;  ///< formulas and words in their order

struct Line {
    Cell label;  ///< empty: none
    std::vector<Cell> cells;
};

/// Errors: invalid_argument with the position (from 1) of the first character that is not valid.
Expected<std::vector<Line>> read_formula(std::string_view text);

}  // namespace tunewright::api::notation
