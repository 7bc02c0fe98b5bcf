// The plain-text notation in which the registry states the formulas of tuning methods, read into a tree, and written as
// MathML.
//
//     PI: Kp = 2 T/(3 K L), Ti = T; PID: Kp = 2 (T1 + T2)/(3 K L), Ti = T1 + T2
//
// "; " and ". " end a line. What stands before the last ": " of a line is its label. ", " ends a cell where an equation
// stands on either side of it. Products are written side by side and bind as a slash does, from left to right: a b/c d
// is (a b/c) d. Powers have ^, magnitudes |x|, indices _ or digits; min, max, exp and sqrt are functions where a
// bracket follows, int and sum signs with limits (int_0^H). A single letter, a Greek name or one of the field's pairs
// of letters (Kp, Ti, Ku, ...) is a symbol; other names are words.
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

using Cell = std::vector<Node>;  ///< formulas and words as they follow each other

struct Line {
    Cell label;  ///< empty: none
    std::vector<Cell> cells;
};

/// Errors: invalid_argument with the character (from 1) at which the text leaves the notation.
Expected<std::vector<Line>> read_formula(std::string_view text);

}  // namespace tunewright::api::notation
