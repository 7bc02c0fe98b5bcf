#include "engine/code/composer.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tunewright::code {
namespace {

/// Replaces the variables of a program.
class Rewriter {
public:
    explicit Rewriter(const std::map<std::string, Expr>& variables) : variables_(variables) {}

    Expr operator()(const Expr& expression) const {
        if (std::holds_alternative<Literal>(expression->what)) return expression;
        if (const auto* place = std::get_if<VariableReference>(&expression->what)) {
            const Expr& variable = variables_.at(place->name);
            return place->index.empty() ? variable : element(variable, (*this)(place->index[0]));
        }
        Operated what = std::get<Operated>(expression->what);
        for (Expr& operand : what.operands) operand = (*this)(operand);
        return Expr(Expression{expression->type, std::move(what)});
    }

    Block operator()(const Block& block) const {
        Block out;
        for (const Statement& statement : block) out.push_back(std::visit(*this, statement.what));
        return out;
    }

    Statement operator()(const Assignment& what) const { return assign((*this)(what.target), (*this)(what.value)); }
    Statement operator()(const Decision& what) const {
        return when((*this)(what.condition), (*this)(what.then), (*this)(what.otherwise));
    }
    Statement operator()(const Repetition& what) const {
        return repeat((*this)(what.index), what.count, (*this)(what.body));
    }
    Statement operator()(const Remark& what) const { return {what}; }

private:
    const std::map<std::string, Expr>& variables_;
};

/// The variable of the whole that takes the place of an embedded one.
std::optional<Expr> shared(const Program& whole, const Declaration& part) {
    for (const Declaration& known : whole.variables)
        if (known.name == part.name && known.role == part.role &&
            (known.role == VariableRole::parameter || known.role == VariableRole::output))
            return Expr(Expression{known.type, VariableReference{known.role, known.name}});
    return std::nullopt;
}

std::string of_state(const std::string& name, std::size_t i) { return name + "_x" + std::to_string(i + 1); }

Expr state_of(const std::string& name, std::size_t i) {
    return Expr(Expression{Type::real, VariableReference{VariableRole::state, of_state(name, i)}});
}

/// sum + factor x, without terms that do nothing.
std::optional<Expr> plus(const std::optional<Expr>& sum, double factor, const Expr& x) {
    if (factor == 0) return sum;
    if (!sum) return factor == 1 ? x : factor * x;
    if (factor < 0) return factor == -1 ? *sum - x : *sum - (-factor) * x;
    return factor == 1 ? *sum + x : *sum + factor * x;
}

}  // namespace

Expr Composer::input(const std::string& name, const char* comment) {
    return declare(VariableRole::input, name, comment, Type::real);
}
Expr Composer::optional_input(const std::string& name, const char* comment, Type type, double otherwise) {
    return program_.declare({.role = VariableRole::input,
                             .type = type,
                             .name = name,
                             .comment = comment,
                             .initial = otherwise,
                             .optional = true});
}
Expr Composer::output(const std::string& name, const char* comment) {
    return declare(VariableRole::output, name, comment, Type::real);
}
Expr Composer::setting(const std::string& name, double value, const char* comment, Type type) {
    return program_.declare(
        {.role = VariableRole::parameter, .type = type, .name = name, .comment = comment, .initial = value});
}
Expr Composer::setting_of(const Program& part, const std::string& name, const std::string& renamed,
                          const char* comment) {
    Declaration declaration = *std::ranges::find(part.variables, name, &Declaration::name);
    declaration.name = renamed;
    if (comment != nullptr) declaration.comment = comment;
    const auto known = shared(program_, declaration);
    return known ? *known : program_.declare(std::move(declaration));
}
Expr Composer::state(const std::string& name, const char* comment, Type type, int length) {
    return declare(VariableRole::state, name, comment, type, length);
}
Expr Composer::local(const std::string& name, const char* comment, Type type) {
    return declare(VariableRole::local, name, comment, type);
}

Embedded Composer::embed(const Program& part, const Embedding& how) {
    Embedded out;
    for (Declaration declaration : part.variables) {
        const std::string own = declaration.name;
        if (const auto bound = how.bound.find(own); bound != how.bound.end()) {
            out.variables.emplace(own, bound->second);
            continue;
        }
        declaration.name = how.renamed(own);
        auto variable = shared(program_, declaration);
        if (declaration.role == VariableRole::output) declaration.role = VariableRole::local;
        if (!variable) variable = program_.declare(std::move(declaration));
        out.variables.emplace(own, *variable);
    }
    out.body = Rewriter(out.variables)(part.body);
    return out;
}

Expr Composer::lead_lag(const std::string& name, const Expr& x, const Expr& before, const Expr& K, const Expr& Tz,
                        const Expr& Tp, const Expr& Ts) {
    const Expr out = local(name, "output of the lead-lag"), slope = local(name + "_slope", "slope of its lag"),
               lag = state(name + "_lag", "its input behind the lag");
    begin_with(assign(lag, before));
    add(assign(slope, (x - lag) / (Tp + Ts)));
    add(assign(lag, lag + Ts * slope));
    add(assign(out, K * (lag + Tz * slope)));
    return out;
}

Expr Composer::delayed(const std::string& name, const Expr& x, const Expr& before, double calls) {
    const int whole_calls = static_cast<int>(std::floor(calls));
    const double rest = calls - whole_calls;
    const Expr out = local(name, "after the dead time");
    Expr now = x;
    if (whole_calls > 0) {
        const Expr ring = state(name + "_ring", "values of the last calls, in a ring", Type::real, whole_calls),
                   place = state(name + "_place", "index of the oldest value in the ring", Type::integer),
                   k = local(name + "_k", "counts", Type::integer);
        begin_with(repeat(k, whole_calls, {assign(element(ring, k), before)}));
        begin_with(assign(place, whole(0)));
        add(assign(out, element(ring, place)));
        add(assign(element(ring, place), x));
        add(assign(place, place + whole(1)));
        add(when(place >= whole(whole_calls), {assign(place, whole(0))}));
        now = out;
    }
    if (rest == 0) {
        if (whole_calls == 0) add(assign(out, x));
        return out;
    }
    const Expr last = state(name + "_last", "the same a call ago"),
               newer = local(name + "_now", "the newer of two calls");
    begin_with(assign(last, before));
    add(assign(newer, now));
    add(assign(out, newer + rest * (last - newer)));
    add(assign(last, newer));
    return out;
}

Expr Composer::system_output(const std::string& name, const DiscreteSystem& system, const Expr& v) {
    const Expr out = local(name, "output of the linear system");
    std::optional<Expr> sum;
    for (std::size_t i = 0; i < system.C.size(); ++i) {
        const Expr x = state(of_state(name, i), "its state");
        begin_with(assign(x, 0.0));
        sum = plus(sum, system.C[i], x);
    }
    add(assign(out, plus(sum, system.D, v).value_or(0.0)));
    return out;
}

void Composer::move_system(const std::string& name, const DiscreteSystem& system, const Expr& v,
                           const std::vector<double>& Gamma1, const Expr& late) {
    const std::size_t n = system.C.size();
    Block moved;
    for (std::size_t i = 0; i < n; ++i) {
        std::optional<Expr> sum;
        for (std::size_t j = 0; j < n; ++j) sum = plus(sum, system.Phi[i * n + j], state_of(name, j));
        sum = plus(sum, system.Gamma[i], v);
        if (!Gamma1.empty()) sum = plus(sum, Gamma1[i], late);
        // A single state needs no copy.
        const Expr next = n == 1 ? state_of(name, i) : local(of_state(name, i) + "_next", "its state of the next call");
        add(assign(next, sum.value_or(0.0)));
        if (n > 1) moved.push_back(assign(state_of(name, i), next));
    }
    add(moved);
}

Program Composer::take(const Expr& restart, std::vector<std::string> notes) {
    if (!begin_.empty()) {
        const Expr running = state("running", "false before the first call", Type::boolean);
        Block body{remark("The first call, and a restart."),
                   when(either(restart, inverse(running)), std::move(begin_))};
        body.insert(body.end(), program_.body.begin(), program_.body.end());
        body.push_back(assign(running, truth(true)));
        program_.body = std::move(body);
    }
    program_.notes = std::move(notes);
    return std::move(program_);
}

}  // namespace tunewright::code
