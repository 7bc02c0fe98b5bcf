// Parses an expression's text into a tree.
//
//   expression: comparison [ "?" expression ":" expression ]           right associative
//   comparison: sum [ ("<" | "<=" | ">" | ">=" | "==" | "!=") sum ]    1 if it holds, else 0; not chained
//   sum:        term { ("+" | "-") term }
//   term:       signed { ("*" | "/") signed }
//   signed:     ("-" | "+") signed | power                             -a^2 is -(a^2)
//   power:      operand [ "^" signed ]                                 right associative; 2^-1 is 1/2
//   operand:    number | name | "(" expression ")" | function "(" expression { "," expression } ")"
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/expression/operation.h"

namespace tunewright {

/// Limits on the size of a text.
struct ExpressionLimits {
    int length = 10000;  ///< bytes of one expression
    int depth = 100;     ///< nesting of parentheses, signs, powers and conditionals
    int nodes = 5000;    ///< numbers, names and operations, including
    int used = 0;        ///< those of the expressions that were read before
};

struct SyntaxNode {
    Operation operation = Operation::number;
    int operands[3] = {-1, -1, -1};  ///< indices of nodes before this one
    double number = 0;               ///< of Operation::number
    int name = -1;                   ///< of Operation::variable: index into the tree's names
    int position = 1;                ///< position of the operator, name or number: character, from 1
};

/// The last node is the root.
struct SyntaxTree {
    std::vector<SyntaxNode> nodes;
    std::vector<std::string> names;  ///< each once
};

/// Errors: the fault with its character and the quoted text ("character 17: ..."), or the limit that is exceeded.
Expected<SyntaxTree> parse_expression(std::string_view text, const ExpressionLimits& limits = {});

/// exp, log, ...: names that states, parameters and inputs must not have.
bool is_function_name(std::string_view name);

}  // namespace tunewright
