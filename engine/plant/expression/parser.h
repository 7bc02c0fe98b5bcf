// An expression's text as a tree.
//
//   expression: comparison [ "?" expression ":" expression ]           right associative
//   comparison: sum [ ("<" | "<=" | ">" | ">=" | "==" | "!=") sum ]    1 where it holds, else 0; not chained
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

/// What a text may cost.
struct ExpressionLimits {
    int length = 10000;  ///< bytes of one expression
    int depth = 100;     ///< parentheses, signs, powers and conditionals inside one another
    int nodes = 5000;    ///< numbers, names and operations, together with
    int used = 0;        ///< those of expressions read before
};

struct SyntaxNode {
    Operation operation = Operation::number;
    int operands[3] = {-1, -1, -1};  ///< nodes that stand before this one
    double number = 0;               ///< of Operation::number
    int name = -1;                   ///< of Operation::variable: index into the tree's names
    int position = 1;                ///< of the operator, name or number: character, from 1
};

/// The last node is the root.
struct SyntaxTree {
    std::vector<SyntaxNode> nodes;
    std::vector<std::string> names;  ///< each once
};

/// Errors: what is wrong and at which character, quoting the piece ("character 17: ..."), or which limit is passed.
Expected<SyntaxTree> parse_expression(std::string_view text, const ExpressionLimits& limits = {});

/// exp, log, ...: names that no state, parameter or input may have.
bool is_function_name(std::string_view name);

}  // namespace tunewright
