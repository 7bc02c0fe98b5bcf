#include "engine/code/composer.h"

#include <algorithm>
#include <cmath>

namespace tunewright::code {
namespace {

/// Replaces the variables of a program.
struct Rewriter {
    const std::map<std::string, Expr>& variables;

    Expr operator()(const Expr& expression) const {
        if (std::holds_alternative<Literal>(expression->what)) return expression;
        if (const auto* place = std::get_if<VariableReference>(&expression->what)) {
            const Expr& variable = variables.at(place->name);
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
};

/// Adds factor x to a sum, without terms and factors that do nothing.
void add_term(std::vector<Expr>& sum, double factor, const Expr& x) {
    if (factor == 0) return;
    const Expr term = std::abs(factor) == 1 ? x : std::abs(factor) * x;
    if (sum.empty()) return sum.push_back(factor < 0 ? -term : term);
    sum[0] = factor < 0 ? sum[0] - term : sum[0] + term;
}

Expr total(const std::vector<Expr>& sum) { return sum.empty() ? Expr(0.0) : sum[0]; }

std::string state_name(const std::string& system, std::size_t i) { return system + "_x" + std::to_string(i + 1); }

}  // namespace

Composer::Composer(std::string name, std::string title) {
    program_.name = std::move(name);
    program_.title = std::move(title);
}

Composer::Composer(std::string name, std::string title, double Ts) : Composer(std::move(name), std::move(title)) {
    setting("Ts", Ts, "sample time in s: the time from call to call");
    setting("at_rest", 0, "true: in the first call everything is at rest at the operating point", Type::boolean);
    setting("restart", 0, "true: this call starts again as the first one", Type::boolean);
}

Expr Composer::operator[](const std::string& name) const {
    const auto& known = *std::ranges::find(program_.variables, name, &Declaration::name);
    return Expr(Expression{known.type, VariableReference{known.role, known.name}});
}

Expr Composer::optional_input(const std::string& name, const char* comment, Type type, double otherwise) {
    const Expr out = declare(VariableRole::input, name, comment, type);
    program_.variables.back().initial = otherwise;
    program_.variables.back().optional = true;
    return out;
}

Expr Composer::setting(const std::string& name, double value, const char* comment, Type type) {
    const Expr out = declare(VariableRole::parameter, name, comment, type);
    program_.variables.back().initial = value;
    return out;
}

Expr Composer::let(const std::string& name, const char* comment, const Expr& value) {
    const Expr out = local(name, comment, value->type);
    add(assign(out, value));
    return out;
}

void Composer::add_bounded(const Expr& x, const Expr& value, const Expr& low, const Expr& high) {
    add(assign(x, value));
    keep_within(program_.body, x, low, high);
}

void Composer::embed(const Program& part, const std::map<std::string, std::string>& names, const std::string& prefix,
                     const std::string& suffix) {
    std::map<std::string, Expr> variables;
    for (Declaration own : part.variables) {
        const std::string before = own.name;
        const auto given = names.find(before);
        const bool common = before == "Ts" || before == "at_rest" || before == "restart";
        own.name = given != names.end() ? given->second : common ? before : prefix + before + suffix;
        const bool memory = own.role == VariableRole::state || own.role == VariableRole::local;
        if (std::ranges::find(program_.variables, own.name, &Declaration::name) != program_.variables.end() &&
            (given != names.end() || !memory)) {
            variables.emplace(before, (*this)[own.name]);
        } else {
            if (own.role == VariableRole::output) own.role = VariableRole::local;
            variables.emplace(before, program_.declare(std::move(own)));
        }
    }
    const Block body = Rewriter{variables}(part.body);
    program_.body.insert(program_.body.end(), body.begin(), body.end());
}

Expr Composer::lead_lag(const std::string& name, const Expr& x, const Expr& before, const Expr& K, const Expr& lead,
                        const Expr& lag) {
    const Expr lagged = state(name + "_lagged", "input of the lead-lag behind its lag");
    begin_with(assign(lagged, before));
    const Expr slope = let(name + "_slope", "slope of it", (x - lagged) / (lag + (*this)["Ts"]));
    add(assign(lagged, lagged + (*this)["Ts"] * slope));
    return let(name, "output of the lead-lag", K * (lagged + lead * slope));
}

Expr Composer::delayed(const std::string& name, const Expr& x, const Expr& before, double calls) {
    const int whole_calls = static_cast<int>(std::floor(calls));
    Expr now = x;
    if (whole_calls > 0) {
        const Expr ring = state(name + "_ring", "values of the last calls, in a ring", Type::real, whole_calls),
                   place = state(name + "_place", "index of the oldest value in the ring", Type::integer),
                   k = local(name + "_k", "counts", Type::integer);
        begin_with(repeat(k, whole_calls, {assign(element(ring, k), before)}));
        begin_with(assign(place, whole(0)));
        now = let(name + "_now", "the oldest of them", element(ring, place));
        add(assign(element(ring, place), x));
        add(assign(place, place + whole(1)));
        add(when(place >= whole(whole_calls), {assign(place, whole(0))}));
    }
    if (calls == whole_calls) return now;
    const Expr last = state(name + "_last", "the same a call ago");
    begin_with(assign(last, before));
    const Expr out = let(name, "after the dead time", now + (calls - whole_calls) * (last - now));
    add(assign(last, now));
    return out;
}

Expr Composer::system(const std::string& name, const DiscreteSystem& system, const Expr& v) {
    std::vector<Expr> sum;
    for (std::size_t i = 0; i < system.C.size(); ++i) {
        const Expr x = state(state_name(name, i), "state of a linear system");
        begin_with(assign(x, 0.0));
        add_term(sum, system.C[i], x);
    }
    add_term(sum, system.D, v);
    return let(name, "output of a linear system", total(sum));
}

void Composer::move(const std::string& name, const DiscreteSystem& system, const Expr& v, const Expr& late) {
    std::vector<Expr> next;
    for (std::size_t i = 0, n = system.C.size(); i < n; ++i) {
        std::vector<Expr> sum;
        for (std::size_t j = 0; j < n; ++j) add_term(sum, system.Phi[i * n + j], (*this)[state_name(name, j)]);
        add_term(sum, system.Gamma[i], v);
        if (!system.Gamma_late.empty()) add_term(sum, system.Gamma_late[i], late);
        next.push_back(let(state_name(name, i) + "_next", "the same in the next call", total(sum)));
    }
    for (std::size_t i = 0; i < next.size(); ++i) add(assign((*this)[state_name(name, i)], next[i]));
}

Program Composer::take(std::vector<std::string> notes) {
    if (!begin_.empty()) {
        const Expr running = state("running", "false before the first call", Type::boolean);
        const Expr first = either((*this)["restart"], inverse(running));
        program_.body.insert(program_.body.begin(),
                             {remark("The first call, and a restart."), when(first, std::move(begin_))});
        add(assign(running, truth(true)));
    }
    program_.notes = std::move(notes);
    return std::move(program_);
}

}  // namespace tunewright::code
