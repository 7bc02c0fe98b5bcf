// Executes a controller's program directly, independent of any language.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

class Machine {
public:
    explicit Machine(const Program& program) : program_(program) {
        for (const Declaration& variable : program.variables)
            cells_[variable.name].assign(static_cast<std::size_t>(std::max(variable.length, 1)),
                                         variable.role == VariableRole::local || variable.role == VariableRole::output
                                             ? std::nan("")
                                             : variable.initial);
    }

    double& operator[](const std::string& name) { return cells_.at(name).front(); }
    bool has(const std::string& name) const { return cells_.contains(name); }

    double step(double r, double y, bool manual = false, double manual_output = 0) {
        (*this)["setpoint"] = r;
        (*this)["measurement"] = y;
        (*this)["manual"] = manual ? 1 : 0;
        (*this)["manual_output"] = manual_output;
        // A local that is read before it is assigned gives NaN.
        for (const Declaration& variable : program_.variables)
            if (variable.role == VariableRole::local) (*this)[variable.name] = std::nan("");
        run(program_.body);
        return (*this)["u"];
    }

private:
    double& cell(const VariableReference& place) {
        std::size_t index = 0;
        if (!place.index.empty()) index = static_cast<std::size_t>(value(place.index[0]));
        return cells_.at(place.name).at(index);
    }

    double value(const Expr& expression) {
        if (const auto* literal = std::get_if<Literal>(&expression->what)) return literal->value;
        if (const auto* place = std::get_if<VariableReference>(&expression->what)) return cell(*place);
        const auto& what = std::get<Operated>(expression->what);
        const double a = value(what.operands[0]), b = what.operands.size() > 1 ? value(what.operands[1]) : 0;
        switch (what.operation) {
            case Operation::add: return a + b;
            case Operation::subtract: return a - b;
            case Operation::multiply: return a * b;
            case Operation::divide: return a / b;
            case Operation::less: return a < b ? 1 : 0;
            case Operation::greater: return a > b ? 1 : 0;
            case Operation::greater_equal: return a >= b ? 1 : 0;
            case Operation::not_equal: return a != b ? 1 : 0;
            case Operation::logical_and: return a != 0 && b != 0 ? 1 : 0;
            case Operation::logical_or: return a != 0 || b != 0 ? 1 : 0;
            case Operation::negate: return -a;
            case Operation::logical_not: return a != 0 ? 0 : 1;
            case Operation::exponential: return std::exp(a);
        }
        throw std::logic_error("operation");
    }

    void run(const Block& block) {
        for (const Statement& statement : block) {
            if (const auto* assignment = std::get_if<Assignment>(&statement.what)) {
                cell(std::get<VariableReference>(assignment->target->what)) = value(assignment->value);
            } else if (const auto* decision = std::get_if<Decision>(&statement.what)) {
                run(value(decision->condition) != 0 ? decision->then : decision->otherwise);
            } else if (const auto* repetition = std::get_if<Repetition>(&statement.what)) {
                double& index = cell(std::get<VariableReference>(repetition->index->what));
                for (int i = 0; i < repetition->count; ++i) {
                    index = i;
                    run(repetition->body);
                }
            }
        }
    }

    const Program& program_;
    std::map<std::string, std::vector<double>> cells_;
};

}  // namespace tunewright::code
