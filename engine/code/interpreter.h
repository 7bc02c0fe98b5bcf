// Executes a program as it is, independent of any language: for simulations of what the printed text computes.
//
//     Interpreter program(*pid_algorithm(law, options));
//     program["setpoint"] = 1;
//     program["measurement"] = y;
//     program.call();
//     const double u = program["u"];
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

class Interpreter {
public:
    explicit Interpreter(const Program& program);

    bool has(const std::string& name) const { return place_.contains(name); }
    /// A variable, of an array its first element; Booleans are 0 and 1. The reference holds as long as this object.
    /// Throws std::out_of_range for a name that the program does not have.
    double& operator[](const std::string& name) { return cells_[static_cast<std::size_t>(place_.at(name))]; }

    /// One call. A local that is read before it is assigned is not a number.
    void call();

private:
    friend class ProgramCompiler;

    /// A step of a machine with a stack.
    struct Instruction {
        enum class Code { number, cell, element, store, store_element, jump_unless, jump, operation } code{};
        Operation operation{};
        int at = 0;  ///< cell, or instruction to go to
        double number = 0;
    };

    std::map<std::string, int> place_;
    std::vector<double> cells_, stack_;
    std::vector<Instruction> instructions_;
    std::size_t first_local_ = 0;
};

}  // namespace tunewright::code
