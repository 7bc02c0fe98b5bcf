#include "engine/plant/expression/program.h"

#include <cmath>

#include "engine/number_text.h"

namespace tunewright {

std::string Program::describe(int instruction, double a, double b, double result) const {
    const Origin& origin = origins_[static_cast<std::size_t>(instruction)];
    const Operation operation = instructions_[static_cast<std::size_t>(instruction)].operation;
    const std::string name = spelling(origin.written);
    const std::string failure = std::isnan(result)   ? " does not exist"
                                : std::isinf(result) ? " is not finite"
                                                     : " has no finite derivative";
    std::string what;
    if (origin.written == Operation::power) {
        what = operation == Operation::log ? "a power of " + text(a) +
                                                 " with an exponent that is not "
                                                 "constant"
               : operation == Operation::power            ? text(a) + " ^ " + text(b)
               : operation == Operation::divide && b == 0 ? "a negative power of 0"
                                                          : "a power";
        what += failure;
    } else if (operation == Operation::divide && b == 0) {
        what = "division by zero";
    } else if (operand_count(operation) == 1) {
        what = name + " of " + text(a) + failure;
    } else {
        what = text(a) + " " + name + " " + text(b) + " is out of the number range";
    }
    return place(instruction) + ": " + what;
}

std::string Program::place(int instruction) const {
    const Origin& origin = origins_[static_cast<std::size_t>(instruction)];
    return sources_[static_cast<std::size_t>(origin.source)] + ", character " + std::to_string(origin.position);
}

std::vector<bool> Program::variables_of(int output) const {
    std::vector<bool> needed(static_cast<std::size_t>(registers()), false);
    const int first = variables_ + static_cast<int>(constants_.size());
    needed[static_cast<std::size_t>(output_register(output))] = true;
    for (int at = registers() - 1; at >= first; --at) {
        if (!needed[static_cast<std::size_t>(at)]) continue;
        const Instruction& i = instructions_[static_cast<std::size_t>(at - first)];
        for (const auto operand : {i.a, i.b, i.c}) needed[operand] = true;
    }
    needed.resize(static_cast<std::size_t>(variables_));
    return needed;
}

}  // namespace tunewright
