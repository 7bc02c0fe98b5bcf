#include "engine/code/interpreter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tunewright::code {

Interpreter::Interpreter(const Program& program) {
    for (const bool local : {false, true}) {
        if (local) first_local_ = cells_.size();
        for (const Declaration& variable : program.variables) {
            if ((variable.role == VariableRole::local) != local) continue;
            place_[variable.name] = cells_.size();
            cells_.insert(cells_.end(), static_cast<std::size_t>(std::max(variable.length, 1)), variable.initial);
        }
    }
    body_ = action_of(program.body);
}

void Interpreter::call() {
    std::fill(cells_.begin() + static_cast<std::ptrdiff_t>(first_local_), cells_.end(),
              std::numeric_limits<double>::quiet_NaN());
    body_();
}

std::function<double&()> Interpreter::place_of(const Expr& variable) {
    const auto& place = std::get<VariableReference>(variable->what);
    double* cell = &(*this)[place.name];
    if (place.index.empty()) return [cell]() -> double& { return *cell; };
    return [this, at = place_.at(place.name), index = value_of(place.index[0])]() -> double& {
        return cells_.at(at + static_cast<std::size_t>(index()));
    };
}

Interpreter::Value Interpreter::value_of(const Expr& expression) {
    if (const auto* literal = std::get_if<Literal>(&expression->what)) return [x = literal->value] { return x; };
    if (const auto* place = std::get_if<VariableReference>(&expression->what)) {
        if (place->index.empty()) return [cell = &(*this)[place->name]] { return *cell; };
        return place_of(expression);
    }
    const auto& what = std::get<Operated>(expression->what);
    const Value a = value_of(what.operands[0]), b = what.operands.size() > 1 ? value_of(what.operands[1]) : Value();
    switch (what.operation) {
        case Operation::add: return [=] { return a() + b(); };
        case Operation::subtract: return [=] { return a() - b(); };
        case Operation::multiply: return [=] { return a() * b(); };
        case Operation::divide: return [=] { return a() / b(); };
        case Operation::less: return [=] { return a() < b() ? 1.0 : 0.0; };
        case Operation::greater: return [=] { return a() > b() ? 1.0 : 0.0; };
        case Operation::greater_equal: return [=] { return a() >= b() ? 1.0 : 0.0; };
        case Operation::equal: return [=] { return a() == b() ? 1.0 : 0.0; };
        case Operation::not_equal: return [=] { return a() != b() ? 1.0 : 0.0; };
        case Operation::logical_and: return [=] { return a() != 0 && b() != 0 ? 1.0 : 0.0; };
        case Operation::logical_or: return [=] { return a() != 0 || b() != 0 ? 1.0 : 0.0; };
        case Operation::negate: return [=] { return -a(); };
        case Operation::logical_not: return [=] { return a() != 0 ? 0.0 : 1.0; };
        case Operation::exponential: return [=] { return std::exp(a()); };
    }
    throw std::logic_error("operation");
}

Interpreter::Action Interpreter::action_of(const Block& block) {
    std::vector<Action> steps;
    for (const Statement& statement : block) {
        if (const auto* assignment = std::get_if<Assignment>(&statement.what)) {
            steps.emplace_back([to = place_of(assignment->target), value = value_of(assignment->value)] {
                const double x = value();
                to() = x;
            });
        } else if (const auto* decision = std::get_if<Decision>(&statement.what)) {
            steps.emplace_back([holds = value_of(decision->condition), then = action_of(decision->then),
                                otherwise = action_of(decision->otherwise)] { holds() != 0 ? then() : otherwise(); });
        } else if (const auto* repetition = std::get_if<Repetition>(&statement.what)) {
            steps.emplace_back(
                [index = place_of(repetition->index), count = repetition->count, body = action_of(repetition->body)] {
                    for (int i = 0; i < count; ++i) {
                        index() = i;
                        body();
                    }
                });
        }
    }
    return [steps = std::move(steps)] {
        for (const Action& step : steps) step();
    };
}

}  // namespace tunewright::code
