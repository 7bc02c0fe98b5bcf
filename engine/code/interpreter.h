// Executes a program, independent of any language: for simulations of what the printed text computes.
//
//     Interpreter program(*pid_algorithm(law, options));
//     program["setpoint"] = 1;
//     program["measurement"] = y;
//     program.call();
//     const double u = program["u"];
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

class Interpreter {
public:
    explicit Interpreter(const Program& program);
    Interpreter(const Interpreter&) = delete;
    Interpreter& operator=(const Interpreter&) = delete;

    bool has(const std::string& name) const { return place_.contains(name); }
    /// A variable, of an array its first element; Booleans are 0 and 1. The reference holds as long as this object.
    /// Throws std::out_of_range for a name that the program does not have.
    double& operator[](const std::string& name) { return cells_[place_.at(name)]; }

    /// One call. A local that is read before it is assigned is not a number.
    void call();

private:
    using Value = std::function<double()>;
    using Action = std::function<void()>;

    Value value_of(const Expr& expression);
    std::function<double&()> place_of(const Expr& variable);
    Action action_of(const Block& block);

    std::map<std::string, std::size_t> place_;
    std::vector<double> cells_;  // the locals are the last
    std::size_t first_local_ = 0;
    Action body_;
};

}  // namespace tunewright::code
