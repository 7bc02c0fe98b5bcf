// The operations of an expression.
#pragma once

#include <cstdint>

namespace tunewright {

enum class Operation : std::uint8_t {
    number,    ///< only in syntax trees
    variable,  ///< only in syntax trees: a name
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,  ///< in programs: with a constant exponent that is not a small integer
    less,
    less_equal,
    greater,        ///< only in syntax trees
    greater_equal,  ///< only in syntax trees
    equal,
    not_equal,
    select,  ///< a ? b : c
    exp,
    log,
    sqrt,
    sin,
    cos,
    tan,
    tanh,
    abs,
    min,
    max
};

/// The operation as the user writes it: "+", "exp", "? :".
const char* spelling(Operation operation);

/// Number of operands: 0 to 3.
int operand_count(Operation operation);

}  // namespace tunewright
