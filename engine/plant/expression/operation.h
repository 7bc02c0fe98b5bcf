// What an expression can do.
#pragma once

#include <cstdint>

namespace tunewright {

enum class Operation : std::uint8_t {
    number,    ///< of syntax trees only
    variable,  ///< of syntax trees only: a name
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,  ///< in programs: with a constant exponent that is no small integer
    less,
    less_equal,
    greater,        ///< of syntax trees only
    greater_equal,  ///< of syntax trees only
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

/// As the user writes it: "+", "exp", "? :".
const char* spelling(Operation operation);

/// How many operands it has: 0 to 3.
int operand_count(Operation operation);

}  // namespace tunewright
