// Compiles trees to a program: names become variables or constants, equal operations are computed once (value
// numbering), operations on constants are evaluated at compile time, small integer powers become multiplications, and
// unused operations are removed.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "engine/plant/expression/parser.h"
#include "engine/plant/expression/program.h"

namespace tunewright {

/// The meaning of a name: a variable (its index), a constant (its value), or an error (its sentence).
struct VariableIndex {
    int index = 0;
};
struct UnknownName {
    std::string message;
};
using NameMeaning = std::variant<VariableIndex, double, UnknownName>;

class ProgramBuilder {
public:
    explicit ProgramBuilder(std::vector<std::string> variable_names);

    /// Adds the next output. `source` names the text in messages ("equation T"). Errors: the message of an UnknownName,
    /// with the character.
    std::optional<Error> add_output(const SyntaxTree& tree, const std::string& source,
                                    const std::function<NameMeaning(const std::string&)>& meaning);

    Program finish();

private:
    struct Value {
        Operation operation = Operation::number;  // number, variable, or an instruction
        std::array<int, 3> operands = {};
        double constant = 0;
        Origin origin;
    };

    int constant(double value);
    int instruction(Operation operation, int a, int b, int c, const Origin& origin);
    int power(int base, int exponent, const Origin& origin);
    int integer_power(int base, int exponent, const Origin& origin);
    int lowered(const SyntaxNode& node, const std::vector<int>& values, int source);
    bool is_constant(int value, double wanted) const;

    std::vector<std::string> variable_names_, sources_;
    std::vector<Value> values_;  // operands come before the operations that use them
    std::map<std::uint64_t, int> constants_;
    std::map<std::tuple<Operation, int, int, int>, int> known_;
    std::vector<int> outputs_;
};

}  // namespace tunewright
