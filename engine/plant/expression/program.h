// Compiled expressions: one list of operations over registers, evaluated over any number type (double, complex, dual,
// Taylor). Nothing of the text is ever executed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/plant/expression/operation.h"
#include "engine/plant/expression/scalar.h"

namespace tunewright {

/// result = operation(a, b, c) of registers. Its own register follows from its place in the list.
struct Instruction {
    Operation operation = Operation::add;
    std::uint16_t a = 0, b = 0, c = 0;
};

/// Where in which text an instruction comes from.
struct Origin {
    int source = 0;    ///< index into Program::sources
    int position = 1;  ///< character, from 1
    Operation written = Operation::add;
};

/// Several expressions of the same variables, every operation that they share done once. Registers: the variables, the
/// constants, then one an instruction, each written once. Instructions stand in the order of the outputs.
class Program {
public:
    int variables() const { return variables_; }
    int outputs() const { return static_cast<int>(outputs_.size()); }
    int registers() const {
        return variables_ + static_cast<int>(constants_.size()) + static_cast<int>(instructions_.size());
    }
    std::span<const double> constants() const { return constants_; }
    std::span<const Instruction> instructions() const { return instructions_; }
    int output_register(int output) const { return outputs_[static_cast<std::size_t>(output)]; }
    /// How many instructions outputs 0 to `count` - 1 need.
    int length(int count) const { return count == 0 ? 0 : lengths_[static_cast<std::size_t>(count) - 1]; }

    /// The first out.size() outputs. T: double, std::complex<double> or Dual. Undefined values come out not finite.
    template <class T>
    void evaluate(std::span<const T> variables, std::span<T> out) const;

    /// Why one of the first `count` outputs is not finite (value or derivative): the operation that fails first, with
    /// its operands and its place. Empty if all are finite.
    template <class T>
    std::string fault(std::span<const T> variables, int count) const;

    /// Where an instruction comes from: "equation T, character 17".
    std::string place(int instruction) const;

    /// Which variables an output depends on.
    std::vector<bool> variables_of(int output) const;

private:
    friend class ProgramBuilder;

    template <class T>
    void run(std::span<const T> variables, int length, T* registers) const;
    std::string describe(int instruction, double a, double b, double result) const;

    int variables_ = 0;
    std::vector<double> constants_;
    std::vector<Instruction> instructions_;
    std::vector<Origin> origins_;       // one an instruction
    std::vector<std::string> sources_;  // "equation T"
    std::vector<std::string> variable_names_;
    std::vector<int> outputs_;  // registers
    std::vector<int> lengths_;
};

template <class T>
void Program::run(std::span<const T> variables, int length, T* registers) const {
    T* next = registers;
    for (const T& variable : variables) *next++ = variable;
    for (const double constant : constants_) set_constant(*next++, constant);
    const Instruction* const end = instructions_.data() + length;
    for (const Instruction* i = instructions_.data(); i != end; ++i)
        *next++ = apply(i->operation, registers[i->a], registers[i->b], registers[i->c]);
}

template <class T>
void Program::evaluate(std::span<const T> variables, std::span<T> out) const {
    constexpr int kOnStack = 160;
    const auto count = static_cast<int>(out.size());
    const auto work = [&](T* registers) {
        run(variables, length(count), registers);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = registers[outputs_[i]];
    };
    if (registers() <= kOnStack) {
        std::array<T, kOnStack> stack;
        work(stack.data());
    } else {
        std::vector<T> heap(static_cast<std::size_t>(registers()));
        work(heap.data());
    }
}

template <class T>
std::string Program::fault(std::span<const T> variables, int count) const {
    std::vector<T> values(static_cast<std::size_t>(registers()));
    run(variables, length(count), values.data());
    const int first = variables_ + static_cast<int>(constants_.size());
    const auto finite = [&](int at) { return all_finite(values[static_cast<std::size_t>(at)]); };
    for (int output = 0; output < count; ++output) {
        int at = output_register(output);
        if (finite(at)) continue;
        // Down to an operation whose operands are finite; of a conditional only the branch taken counts.
        while (at >= first) {
            const Instruction& i = instructions_[static_cast<std::size_t>(at - first)];
            const int operands = operand_count(i.operation);
            const bool select = i.operation == Operation::select;
            if (!finite(i.a))
                at = i.a;
            else if (select)
                at = value_part(values[i.a]) != 0 ? i.b : i.c;
            else if (operands > 1 && !finite(i.b))
                at = i.b;
            else
                return describe(at - first, value_part(values[i.a]), value_part(values[i.b]),
                                value_part(values[static_cast<std::size_t>(at)]));
        }
        return (at < variables_ ? variable_names_[static_cast<std::size_t>(at)] : "a constant") + " is not finite";
    }
    return {};
}

}  // namespace tunewright
