// Compiled expressions: one list of operations over registers, evaluated over any number type (double, complex, dual,
// Taylor). The text itself is never executed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/plant/expression/operation.h"

namespace tunewright {

/// result = operation(a, b, c) of registers. The position in the list determines the result's register.
struct Instruction {
    Operation operation = Operation::add;
    std::uint16_t a = 0, b = 0, c = 0;
};

/// The text and the position that an instruction comes from.
struct Origin {
    int source = 0;    ///< index into Program::sources
    int position = 1;  ///< character, from 1
    Operation written = Operation::add;
};

/// Several expressions of the same variables; an operation that they share is computed once. Registers: the variables,
/// the constants, then one for each instruction, each written once. Instructions have the order of the outputs.
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
    /// Number of instructions that outputs 0 to `count` - 1 need.
    int length(int count) const { return count == 0 ? 0 : lengths_[static_cast<std::size_t>(count) - 1]; }

    /// The first out.size() outputs. T: double, std::complex<double> or Dual. Undefined values are not finite.
    template <class T>
    void evaluate(std::span<const T> variables, std::span<T> out) const;

    /// The reason why one of the first `count` outputs is not finite (value or derivative): the operation that fails
    /// first, with its operands and its place. Empty if all are finite.
    template <class T>
    std::string fault(std::span<const T> variables, int count) const;

    /// The place of an instruction in the texts: "equation T, character 17".
    std::string place(int instruction) const;

    /// For each variable: true if the output depends on it.
    std::vector<bool> variables_of(int output) const;

private:
    friend class ProgramBuilder;

    template <class T>
    void run(std::span<const T> variables, int length, T* registers) const;
    std::string describe(int instruction, double a, double b, double result) const;

    int variables_ = 0;
    std::vector<double> constants_;
    std::vector<Instruction> instructions_;
    std::vector<Origin> origins_;       // one for each instruction
    std::vector<std::string> sources_;  // "equation T"
    std::vector<std::string> variable_names_;
    std::vector<int> outputs_;  // registers
    std::vector<int> lengths_;
};

}  // namespace tunewright
