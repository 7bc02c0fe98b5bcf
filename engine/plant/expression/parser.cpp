#include "engine/plant/expression/parser.h"

#include <algorithm>
#include <map>
#include <optional>

#include "engine/plant/expression/tokens.h"

namespace tunewright {
namespace {

constexpr Operation kFunctions[] = {Operation::exp, Operation::log,  Operation::sqrt, Operation::sin, Operation::cos,
                                    Operation::tan, Operation::tanh, Operation::abs,  Operation::min, Operation::max};
constexpr const char* kFunctionList = "exp, log, sqrt, sin, cos, tan, tanh, abs, min and max";

std::optional<Operation> function_of(std::string_view name) {
    for (const Operation function : kFunctions)
        if (name == spelling(function)) return function;
    return std::nullopt;
}

std::optional<Operation> comparison_of(std::string_view symbol) {
    for (const Operation operation : {Operation::less, Operation::less_equal, Operation::greater,
                                      Operation::greater_equal, Operation::equal, Operation::not_equal})
        if (symbol == spelling(operation)) return operation;
    return std::nullopt;
}

// Recursive descent; every function returns the node that it made, or -1 after the first error. The depth limit bounds
// the recursion, because each cycle of calls passes through `deeper`.
class Parser {
public:
    Parser(std::string_view text, const ExpressionLimits& limits) : reader_(text), limits_(limits) {}

    Expected<SyntaxTree> parse() {
        advance();
        if (!error_ && token_.kind == TokenKind::end)
            return Error{ErrorKind::invalid_argument, "", "the expression is empty."};
        expression();
        if (!error_ && token_.kind != TokenKind::end) unexpected("an operator or the end");
        if (error_) return *error_;
        return std::move(tree_);
    }

private:
    struct Level {
        explicit Level(int& depth) : depth_(depth) { ++depth_; }
        ~Level() { --depth_; }
        int& depth_;
    };

    void advance() {
        if (error_) return;
        previous_ = token_;
        auto next = reader_.next();
        if (next)
            token_ = *next;
        else
            error_ = next.error();
    }

    int fail(int position, const std::string& what) {
        if (!error_) error_ = syntax_error(position, what);
        return -1;
    }

    int unexpected(const std::string& wanted) {
        if (token_.kind == TokenKind::end)
            return fail(token_.position, "the expression ends where " + wanted + " belongs.");
        if (token_.kind == TokenKind::symbol && token_.text == "(" && previous_.kind == TokenKind::name)
            return fail(previous_.position, quoted(previous_.text) +
                                                " is not a function; the functions "
                                                "are " +
                                                kFunctionList + ". A product needs a *.");
        return fail(token_.position, quoted(token_.text) + " stands where " + wanted + " belongs.");
    }

    bool at(std::string_view symbol) const {
        return !error_ && token_.kind == TokenKind::symbol && token_.text == symbol;
    }

    bool skip(std::string_view symbol) {
        if (!at(symbol)) return false;
        advance();
        return true;
    }

    bool deeper() {
        if (error_) return false;
        if (depth_ <= limits_.depth) return true;
        fail(token_.position, "the expression is nested more than " + std::to_string(limits_.depth) + " levels deep.");
        return false;
    }

    int node(const SyntaxNode& made) {
        if (error_) return -1;
        if (limits_.used + static_cast<int>(tree_.nodes.size()) >= limits_.nodes)
            return fail(made.position, "the expressions have more than " + std::to_string(limits_.nodes) +
                                           " numbers, names and operations.");
        tree_.nodes.push_back(made);
        return static_cast<int>(tree_.nodes.size()) - 1;
    }

    int operation(Operation operation, int position, int a, int b = -1, int c = -1) {
        return node({.operation = operation, .operands = {a, b, c}, .number = 0, .name = -1, .position = position});
    }

    int expression() {
        const Level level(depth_);
        if (!deeper()) return -1;
        const int condition = comparison();
        if (!at("?")) return condition;
        const int position = token_.position;
        advance();
        const int yes = expression();
        if (!skip(":")) return error_ ? -1 : unexpected("the \":\" of the conditional");
        const int no = expression();
        return operation(Operation::select, position, condition, yes, no);
    }

    int comparison() {
        int left = sum();
        auto compared = error_ ? std::nullopt : comparison_of(token_.text);
        if (!compared) return left;
        const int position = token_.position;
        advance();
        const int right = sum();
        left = operation(*compared, position, left, right);
        if (!error_ && comparison_of(token_.text))
            return fail(token_.position, "comparisons cannot be chained; write a < b ? b < c : 0 for a < b < c.");
        return left;
    }

    int sum() {
        int left = term();
        while (at("+") || at("-")) {
            const auto what = at("+") ? Operation::add : Operation::subtract;
            const int position = token_.position;
            advance();
            const int right = term();
            left = operation(what, position, left, right);
        }
        return left;
    }

    int term() {
        int left = with_sign();
        while (at("*") || at("/")) {
            const auto what = at("*") ? Operation::multiply : Operation::divide;
            const int position = token_.position;
            advance();
            const int right = with_sign();
            left = operation(what, position, left, right);
        }
        return left;
    }

    int with_sign() {
        const int position = token_.position;
        if (skip("+")) return with_sign_inside();
        if (!skip("-")) return power();
        const int operand = with_sign_inside();
        return operation(Operation::negate, position, operand);
    }

    int with_sign_inside() {
        const Level level(depth_);
        return deeper() ? with_sign() : -1;
    }

    int power() {
        const int base = operand();
        if (!at("^")) return base;
        const int position = token_.position;
        advance();
        const int exponent = with_sign_inside();
        return operation(Operation::power, position, base, exponent);
    }

    int operand() {
        if (error_) return -1;
        if (token_.kind == TokenKind::number) {
            const int made = node({.operation = Operation::number,
                                   .operands = {-1, -1, -1},
                                   .number = token_.number,
                                   .name = -1,
                                   .position = token_.position});
            advance();
            return made;
        }
        if (token_.kind == TokenKind::name) return name_or_call();
        if (!at("(")) return unexpected("a number, a name or a parenthesis");
        const int opened = token_.position;
        advance();
        const int inner = expression();
        if (!error_ && !at(")") && token_.kind == TokenKind::end)
            return fail(opened, "this parenthesis is not closed.");
        if (!skip(")")) return error_ ? -1 : unexpected("an operator or \")\"");
        return inner;
    }

    int name_or_call() {
        const Token name = token_;
        advance();
        const auto function = function_of(name.text);
        if (function) return call(*function, name);
        if (at("(")) return unexpected("an operator");
        const auto [known, added] = name_index_.try_emplace(name.text, static_cast<int>(tree_.names.size()));
        if (added) tree_.names.emplace_back(name.text);
        return node({.operation = Operation::variable,
                     .operands = {-1, -1, -1},
                     .number = 0,
                     .name = known->second,
                     .position = name.position});
    }

    int call(Operation function, const Token& name) {
        const std::string spelt(name.text);
        const bool several = operand_count(function) == 2;
        if (!skip("("))
            return error_ ? -1 : fail(name.position, quoted(name.text) + " is a function: write " + spelt + "(...).");
        int value = expression();
        int given = 1;
        for (; skip(","); ++given) {
            const int next = expression();
            if (several) value = operation(function, name.position, value, next);
        }
        if (error_) return -1;
        if (!at(")") && token_.kind == TokenKind::end)
            return fail(name.position, "the parenthesis of " + quoted(name.text) + " is not closed.");
        if (!skip(")")) return error_ ? -1 : unexpected("an operator or \")\"");
        if (several ? given < 2 : given != 1)
            return fail(name.position, quoted(name.text) + " takes " +
                                           (several ? "two or more arguments" : "one argument") + ", not " +
                                           std::to_string(given) + ".");
        return several ? value : operation(function, name.position, value);
    }

    TokenReader reader_;
    ExpressionLimits limits_;
    Token token_, previous_;
    std::optional<Error> error_;
    SyntaxTree tree_;
    std::map<std::string_view, int> name_index_;
    int depth_ = 0;
};

}  // namespace

Expected<SyntaxTree> parse_expression(std::string_view text, const ExpressionLimits& limits) {
    if (static_cast<int>(std::min<std::size_t>(text.size(), 1u << 30)) > limits.length)
        return Error{ErrorKind::invalid_argument, "",
                     "the expression is " + std::to_string(text.size()) + " characters long; at most " +
                         std::to_string(limits.length) + " are read."};
    return Parser(text, limits).parse();
}

bool is_function_name(std::string_view name) { return function_of(name).has_value(); }

}  // namespace tunewright
