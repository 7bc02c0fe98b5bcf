#include "engine/code/interpreter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright::code {

/// Writes the statements of a program as instructions.
class ProgramCompiler {
public:
    explicit ProgramCompiler(Interpreter& out) : out_(out) {}

    void add(const Block& block) {
        for (const Statement& statement : block) std::visit(*this, statement.what);
    }
    std::size_t deepest() const { return deepest_; }

    void operator()(const Assignment& what) {
        const auto& place = std::get<VariableReference>(what.target->what);
        if (!place.index.empty()) push(place.index[0]);
        push(what.value);
        emit({.code = place.index.empty() ? Code::store : Code::store_element, .at = out_.place_.at(place.name)});
        depth_ = 0;
    }
    void operator()(const Decision& what) {
        push(what.condition);
        const std::size_t skip = emit({.code = Code::jump_unless});
        depth_ = 0;
        add(what.then);
        if (what.otherwise.empty()) return arrive(skip);
        const std::size_t end = emit({.code = Code::jump});
        arrive(skip);
        add(what.otherwise);
        arrive(end);
    }
    void operator()(const Repetition& what) {
        (*this)(Assignment{what.index, whole(0)});
        const int begin = next();
        push(what.index < whole(what.count));
        const std::size_t end = emit({.code = Code::jump_unless});
        depth_ = 0;
        add(what.body);
        (*this)(Assignment{what.index, what.index + whole(1)});
        emit({.code = Code::jump, .at = begin});
        arrive(end);
    }
    void operator()(const Remark&) {}

private:
    using Code = Interpreter::Instruction::Code;

    int next() const { return static_cast<int>(out_.instructions_.size()); }
    std::size_t emit(const Interpreter::Instruction& instruction) {
        out_.instructions_.push_back(instruction);
        return out_.instructions_.size() - 1;
    }
    void arrive(std::size_t jump) { out_.instructions_[jump].at = next(); }

    void push(const Expr& expression) {
        if (const auto* literal = std::get_if<Literal>(&expression->what)) {
            emit({.code = Code::number, .number = literal->value});
            deepest_ = std::max(deepest_, ++depth_);
        } else if (const auto* place = std::get_if<VariableReference>(&expression->what)) {
            if (!place->index.empty()) push(place->index[0]);
            emit({.code = place->index.empty() ? Code::cell : Code::element, .at = out_.place_.at(place->name)});
            if (place->index.empty()) deepest_ = std::max(deepest_, ++depth_);
        } else {
            const auto& what = std::get<Operated>(expression->what);
            for (const Expr& operand : what.operands) push(operand);
            emit({.code = Code::operation, .operation = what.operation});
            depth_ -= what.operands.size() - 1;
        }
    }

    Interpreter& out_;
    std::size_t depth_ = 0, deepest_ = 0;
};

Interpreter::Interpreter(const Program& program) {
    for (const bool local : {false, true}) {
        if (local) first_local_ = cells_.size();
        for (const Declaration& variable : program.variables) {
            if ((variable.role == VariableRole::local) != local) continue;
            place_[variable.name] = static_cast<int>(cells_.size());
            cells_.insert(cells_.end(), static_cast<std::size_t>(std::max(variable.length, 1)), variable.initial);
        }
    }
    ProgramCompiler compiler(*this);
    compiler.add(program.body);
    stack_.resize(compiler.deepest() + 1);
}

void Interpreter::call() {
    std::fill(cells_.begin() + static_cast<std::ptrdiff_t>(first_local_), cells_.end(),
              std::numeric_limits<double>::quiet_NaN());
    double* top = stack_.data();  // one above the last value
    const auto cell = [&](double at) -> double& { return cells_.at(static_cast<std::size_t>(at)); };
    for (std::size_t i = 0; i < instructions_.size(); ++i) {
        const Instruction& now = instructions_[i];
        switch (now.code) {
            case Instruction::Code::number: *top++ = now.number; continue;
            case Instruction::Code::cell: *top++ = cells_[static_cast<std::size_t>(now.at)]; continue;
            case Instruction::Code::element: top[-1] = cell(now.at + top[-1]); continue;
            case Instruction::Code::store: cells_[static_cast<std::size_t>(now.at)] = *--top; continue;
            case Instruction::Code::store_element:
                top -= 2;
                cell(now.at + top[0]) = top[1];
                continue;
            case Instruction::Code::jump_unless:
                if (*--top == 0) i = static_cast<std::size_t>(now.at) - 1;
                continue;
            case Instruction::Code::jump: i = static_cast<std::size_t>(now.at) - 1; continue;
            case Instruction::Code::operation: break;
        }
        switch (now.operation) {
            case Operation::negate: top[-1] = -top[-1]; continue;
            case Operation::logical_not: top[-1] = top[-1] == 0 ? 1 : 0; continue;
            case Operation::exponential: top[-1] = std::exp(top[-1]); continue;
            default: break;
        }
        const double b = *--top, a = top[-1];
        double& out = top[-1];
        switch (now.operation) {
            case Operation::add: out = a + b; break;
            case Operation::subtract: out = a - b; break;
            case Operation::multiply: out = a * b; break;
            case Operation::divide: out = a / b; break;
            case Operation::less: out = a < b ? 1 : 0; break;
            case Operation::greater: out = a > b ? 1 : 0; break;
            case Operation::greater_equal: out = a >= b ? 1 : 0; break;
            case Operation::not_equal: out = a != b ? 1 : 0; break;
            case Operation::logical_and: out = a != 0 && b != 0 ? 1 : 0; break;
            case Operation::logical_or: out = a != 0 || b != 0 ? 1 : 0; break;
            default: break;
        }
    }
}

}  // namespace tunewright::code
