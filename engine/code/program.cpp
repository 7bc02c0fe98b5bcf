#include "engine/code/program.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <stdexcept>

namespace tunewright::code {
namespace {

void require(bool holds, const char* rule) {
    if (!holds) throw std::logic_error(std::string("program: ") + rule);
}

Expr operated(Type type, Operation operation, std::vector<Expr> operands) {
    return Expr(Expression{type, Operated{operation, std::move(operands)}});
}

Expr arithmetic(Operation operation, const Expr& a, const Expr& b) {
    require(a->type == b->type && a->type != Type::boolean, "both operands must be numbers of one type");
    return operated(a->type, operation, {a, b});
}

Expr comparison(Operation operation, const Expr& a, const Expr& b) {
    require(a->type == b->type && a->type != Type::boolean, "only numbers of one type are compared");
    return operated(Type::boolean, operation, {a, b});
}

Expr logical(Operation operation, const Expr& a, const Expr& b) {
    require(a->type == Type::boolean && b->type == Type::boolean, "and, or: both operands must be true or false");
    return operated(Type::boolean, operation, {a, b});
}

// Structured Text does not distinguish upper and lower case.
bool same_name(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

Expr::Expr(double number) : Expr(Expression{Type::real, Literal{number}}) {}
Expr::Expr(Expression expression) : node_(std::make_shared<const Expression>(std::move(expression))) {}

Expr truth(bool value) { return Expr(Expression{Type::boolean, Literal{value ? 1.0 : 0.0}}); }
Expr whole(int value) { return Expr(Expression{Type::integer, Literal{static_cast<double>(value)}}); }

Expr element(const Expr& array, const Expr& index) {
    const auto* place = std::get_if<VariableReference>(&array->what);
    require(place != nullptr && index->type == Type::integer, "an element needs an array and a whole number");
    return Expr(Expression{array->type, VariableReference{place->role, place->name, {index}}});
}

Expr operator+(const Expr& a, const Expr& b) { return arithmetic(Operation::add, a, b); }
Expr operator-(const Expr& a, const Expr& b) { return arithmetic(Operation::subtract, a, b); }
Expr operator*(const Expr& a, const Expr& b) { return arithmetic(Operation::multiply, a, b); }
Expr operator/(const Expr& a, const Expr& b) {
    require(a->type == Type::real, "whole numbers are not divided: languages round them differently");
    return arithmetic(Operation::divide, a, b);
}
Expr operator-(const Expr& a) {
    require(a->type == Type::real, "only a real number is negated");
    return operated(Type::real, Operation::negate, {a});
}
Expr operator<(const Expr& a, const Expr& b) { return comparison(Operation::less, a, b); }
Expr operator>(const Expr& a, const Expr& b) { return comparison(Operation::greater, a, b); }
Expr operator>=(const Expr& a, const Expr& b) { return comparison(Operation::greater_equal, a, b); }
Expr operator==(const Expr& a, const Expr& b) { return comparison(Operation::equal, a, b); }
Expr operator!=(const Expr& a, const Expr& b) { return comparison(Operation::not_equal, a, b); }
Expr both(const Expr& a, const Expr& b) { return logical(Operation::logical_and, a, b); }
Expr either(const Expr& a, const Expr& b) { return logical(Operation::logical_or, a, b); }
Expr inverse(const Expr& a) {
    require(a->type == Type::boolean, "not: the operand must be true or false");
    return operated(Type::boolean, Operation::logical_not, {a});
}
Expr exponential(const Expr& a) {
    require(a->type == Type::real, "exp: the operand must be real");
    return operated(Type::real, Operation::exponential, {a});
}

Statement assign(const Expr& target, const Expr& value) {
    const auto* place = std::get_if<VariableReference>(&target->what);
    require(place != nullptr && place->role != VariableRole::input && place->role != VariableRole::parameter,
            "only states, locals and the output can be assigned");
    require(target->type == value->type, "an assignment must keep the type");
    return {Assignment{target, value}};
}

Statement when(const Expr& condition, Block then, Block otherwise) {
    require(condition->type == Type::boolean && !then.empty(), "a decision needs a condition and a first branch");
    return {Decision{condition, std::move(then), std::move(otherwise)}};
}

Statement repeat(const Expr& index, int count, Block body) {
    require(index->type == Type::integer && count > 0, "a repetition must count whole numbers");
    return {Repetition{index, count, std::move(body)}};
}

Statement remark(std::string text) { return {Remark{std::move(text)}}; }

Block& operator+=(Block& block, Block more) {
    block.insert(block.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    return block;
}

void keep_within(Block& block, const Expr& x, const Expr& low, const Expr& high) {
    block.push_back(when(x > high, {assign(x, high)}));
    block.push_back(when(x < low, {assign(x, low)}));
}

Expr Program::declare(Declaration declaration) {
    require(!same_name(name, declaration.name), "the program itself has this name");
    for (const Declaration& known : variables)
        require(!same_name(known.name, declaration.name),
                "the name is already "
                "used");
    Expr variable(Expression{declaration.type, VariableReference{declaration.role, declaration.name}});
    variables.push_back(std::move(declaration));
    return variable;
}

std::vector<Declaration> of_role(const Program& program, VariableRole role) {
    std::vector<Declaration> out;
    for (const Declaration& variable : program.variables)
        if (variable.role == role) out.push_back(variable);
    return out;
}

}  // namespace tunewright::code
