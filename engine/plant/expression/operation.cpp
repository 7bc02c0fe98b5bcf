#include "engine/plant/expression/operation.h"

namespace tunewright {

const char* spelling(Operation operation) {
    constexpr const char* kSpellings[] = {"number", "name", "+",   "-",    "*",   "/",   "-",   "^",   "<",
                                          "<=",     ">",    ">=",  "==",   "!=",  "? :", "exp", "log", "sqrt",
                                          "sin",    "cos",  "tan", "tanh", "abs", "min", "max"};
    return kSpellings[static_cast<int>(operation)];
}

int operand_count(Operation operation) {
    switch (operation) {
        case Operation::number:
        case Operation::variable: return 0;
        case Operation::select: return 3;
        case Operation::negate:
        case Operation::exp:
        case Operation::log:
        case Operation::sqrt:
        case Operation::sin:
        case Operation::cos:
        case Operation::tan:
        case Operation::tanh:
        case Operation::abs: return 1;
        default: return 2;
    }
}

}  // namespace tunewright
