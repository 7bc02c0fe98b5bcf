#include "engine/plant/expression/program_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "engine/plant/expression/scalar.h"
#include "engine/plant/expression/tokens.h"

namespace tunewright {
namespace {

constexpr int kLargestUnrolledPower = 64;

bool is_commutative(Operation operation) {
    return operation == Operation::add || operation == Operation::multiply || operation == Operation::equal ||
           operation == Operation::not_equal;
}

}  // namespace

ProgramBuilder::ProgramBuilder(std::vector<std::string> variable_names) : variable_names_(std::move(variable_names)) {
    for (std::size_t i = 0; i < variable_names_.size(); ++i)
        values_.push_back({.operation = Operation::variable, .operands = {}, .constant = 0, .origin = {}});
}

int ProgramBuilder::constant(double value) {
    const auto [place, added] = constants_.try_emplace(std::bit_cast<std::uint64_t>(value), values_.size());
    if (added) values_.push_back({.operation = Operation::number, .operands = {}, .constant = value, .origin = {}});
    return place->second;
}

bool ProgramBuilder::is_constant(int value, double wanted) const {
    const Value& v = values_[static_cast<std::size_t>(value)];
    return v.operation == Operation::number && v.constant == wanted;
}

int ProgramBuilder::instruction(Operation operation, int a, int b, int c, const Origin& origin) {
    const auto value = [this](int at) { return values_[static_cast<std::size_t>(at)]; };
    const auto number = [&](int at) { return value(at).operation == Operation::number; };
    if (operation == Operation::select && number(a)) return value(a).constant != 0 ? b : c;
    if (number(a) && number(b) && number(c)) {
        // A constant operation that fails is left in the program: it may be in a branch that is never taken, and at run
        // time its error has a place.
        const double folded = apply(operation, value(a).constant, value(b).constant, value(c).constant);
        if (std::isfinite(folded)) return constant(folded);
    }
    if (operation == Operation::add && is_constant(a, 0)) return b;
    if ((operation == Operation::add || operation == Operation::subtract) && is_constant(b, 0)) return a;
    if (operation == Operation::multiply && is_constant(a, 1)) return b;
    if ((operation == Operation::multiply || operation == Operation::divide) && is_constant(b, 1)) return a;
    if (operation == Operation::subtract && is_constant(a, 0)) {
        operation = Operation::negate;
        a = c = b;
    }
    if (operation == Operation::negate && value(a).operation == Operation::negate) return value(a).operands[0];
    if (is_commutative(operation) && a > b) {
        std::swap(a, b);
        c = a;
    }
    const auto [place, added] = known_.try_emplace({operation, a, b, c}, values_.size());
    if (added) values_.push_back({.operation = operation, .operands = {a, b, c}, .constant = 0, .origin = origin});
    return place->second;
}

int ProgramBuilder::integer_power(int base, int exponent, const Origin& origin) {
    int result = -1, square = base;
    for (int rest = std::abs(exponent); rest > 0; rest /= 2) {
        if (rest % 2 == 1)
            result = result < 0 ? square : instruction(Operation::multiply, result, square, result, origin);
        if (rest > 1) square = instruction(Operation::multiply, square, square, square, origin);
    }
    if (exponent > 0) return result;
    const int one = constant(1);
    return instruction(Operation::divide, one, result, one, origin);
}

int ProgramBuilder::power(int base, int exponent, const Origin& origin) {
    const Value by = values_[static_cast<std::size_t>(exponent)];
    if (by.operation == Operation::number) {
        if (by.constant == 0) return constant(1);
        if (by.constant == std::floor(by.constant) && std::abs(by.constant) <= kLargestUnrolledPower)
            return integer_power(base, static_cast<int>(by.constant), origin);
        return instruction(Operation::power, base, exponent, base, origin);
    }
    const int logarithm = instruction(Operation::log, base, base, base, origin);
    const int product = instruction(Operation::multiply, logarithm, exponent, logarithm, origin);
    return instruction(Operation::exp, product, product, product, origin);
}

int ProgramBuilder::lowered(const SyntaxNode& node, const std::vector<int>& values, int source) {
    const Origin origin{.source = source, .position = node.position, .written = node.operation};
    const auto operand = [&](int which) {
        const int at = node.operands[which];
        return values[static_cast<std::size_t>(at < 0 ? node.operands[0] : at)];
    };
    const int a = operand(0), b = operand(1), c = operand(2);
    switch (node.operation) {
        case Operation::power: return power(a, b, origin);
        case Operation::greater: return instruction(Operation::less, b, a, b, origin);
        case Operation::greater_equal: return instruction(Operation::less_equal, b, a, b, origin);
        default: return instruction(node.operation, a, b, c, origin);
    }
}

std::optional<Error> ProgramBuilder::add_output(const SyntaxTree& tree, const std::string& source,
                                                const std::function<NameMeaning(const std::string&)>& meaning) {
    const int source_index = static_cast<int>(sources_.size());
    sources_.push_back(source);
    std::vector<int> values;
    values.reserve(tree.nodes.size());
    for (const SyntaxNode& node : tree.nodes) {
        if (node.operation == Operation::number) {
            values.push_back(constant(node.number));
        } else if (node.operation == Operation::variable) {
            const NameMeaning what = meaning(tree.names[static_cast<std::size_t>(node.name)]);
            if (const auto* unknown = std::get_if<UnknownName>(&what))
                return syntax_error(node.position, unknown->message);
            if (const auto* number = std::get_if<double>(&what))
                values.push_back(constant(*number));
            else
                values.push_back(std::get<VariableIndex>(what).index);
        } else {
            values.push_back(lowered(node, values, source_index));
        }
    }
    outputs_.push_back(values.back());
    return std::nullopt;
}

Program ProgramBuilder::finish() {
    std::vector<bool> needed(values_.size(), false);
    for (const int output : outputs_) needed[static_cast<std::size_t>(output)] = true;
    for (std::size_t i = values_.size(); i-- > 0;)
        if (needed[i] && values_[i].operation != Operation::number && values_[i].operation != Operation::variable)
            for (const int operand : values_[i].operands) needed[static_cast<std::size_t>(operand)] = true;

    Program program;
    program.variables_ = static_cast<int>(variable_names_.size());
    std::vector<int> place(values_.size(), 0);
    int next = program.variables_;
    for (int i = 0; i < program.variables_; ++i) place[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (needed[i] && values_[i].operation == Operation::number) {
            place[i] = next++;
            program.constants_.push_back(values_[i].constant);
        }
    const int first = next;
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const Value& value = values_[i];
        if (!needed[i] || value.operation == Operation::number || value.operation == Operation::variable) continue;
        const auto at = [&](int k) {
            return static_cast<std::uint16_t>(
                place[static_cast<std::size_t>(value.operands[static_cast<std::size_t>(k)])]);
        };
        program.instructions_.push_back({value.operation, at(0), at(1), at(2)});
        program.origins_.push_back(value.origin);
        place[i] = next++;
    }
    int length = 0;
    for (const int output : outputs_) {
        const int at = place[static_cast<std::size_t>(output)];
        program.outputs_.push_back(at);
        length = std::max(length, at - first + 1);
        program.lengths_.push_back(length);
    }
    program.sources_ = sources_;
    program.variable_names_ = variable_names_;
    return program;
}

}  // namespace tunewright
