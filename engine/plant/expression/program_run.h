// Runs a program over a number type. Separate from its declaration, because the number types take most of the compile
// time and only sources that run programs need them.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/plant/expression/program.h"
#include "engine/plant/expression/scalar.h"

namespace tunewright {

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
        // Goes back to an operation whose operands are finite; in a conditional only the chosen branch counts.
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
