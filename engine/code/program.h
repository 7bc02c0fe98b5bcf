// A controller's program before it is written in a language: declarations, and statements over typed expressions.
//
// Statements: assignments, decisions, a counted loop and remarks. Expressions: numbers, variables, elements of arrays,
// + - * /, comparisons, and, or, not, exp. These are the constructs that Structured Text, C and Python share with the
// same meaning.
//
//     Program program;
//     const Expr x = program.declare({.role = VariableRole::state, .name = "x", .comment = "the sum"});
//     program.body.push_back(assign(x, x + 2 * program.declare({.role = VariableRole::input, .name = "y"})));
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tunewright::code {

enum class Type { real, boolean, integer };

/// Who writes a variable, and how long it lives.
enum class VariableRole {
    input,      ///< given with each call
    parameter,  ///< a setting: has an initial value, the user may write it between two calls
    state,      ///< kept from call to call, private
    local,      ///< valid within one call; assigned before it is read
    output,     ///< the result of a call
};

struct Declaration {
    VariableRole role = VariableRole::local;
    Type type = Type::real;
    std::string name = {};
    std::string comment = {};  ///< one line for the reader
    double initial = 0;        ///< of parameters and states; for Booleans 0 is false
    int length = 0;            ///< > 0: an array of that many elements, indexed from 0
    bool optional = false;     ///< of an input: a call may leave it out where the language can; it is then `initial`
};

enum class Operation {
    add,
    subtract,
    multiply,
    divide,
    less,
    greater,
    greater_equal,
    equal,
    not_equal,
    logical_and,
    logical_or,
    negate,  ///< this and the next two have one operand
    logical_not,
    exponential,
};

struct Expression;

/// A typed expression. Operators combine expressions; operands of the wrong type throw std::logic_error, because they
/// are an error in the code that builds the program.
class Expr {
public:
    Expr(double number);  // NOLINT(google-explicit-constructor)
    explicit Expr(Expression expression);

    const Expression* operator->() const { return node_.get(); }
    const Expression& operator*() const { return *node_; }

private:
    std::shared_ptr<const Expression> node_;
};

struct Literal {
    double value = 0;
};

/// A variable, or an element of one.
struct VariableReference {
    VariableRole role = VariableRole::local;
    std::string name;
    std::vector<Expr> index = {};  ///< none, or one
};

struct Operated {
    Operation operation;
    std::vector<Expr> operands;  ///< one or two
};

struct Expression {
    Type type = Type::real;
    std::variant<Literal, VariableReference, Operated> what;
};

Expr truth(bool value);
Expr whole(int value);
Expr element(const Expr& array, const Expr& index);

Expr operator+(const Expr& a, const Expr& b);
Expr operator-(const Expr& a, const Expr& b);
Expr operator*(const Expr& a, const Expr& b);
Expr operator/(const Expr& a, const Expr& b);
Expr operator-(const Expr& a);
Expr operator<(const Expr& a, const Expr& b);
Expr operator>(const Expr& a, const Expr& b);
Expr operator>=(const Expr& a, const Expr& b);
Expr operator==(const Expr& a, const Expr& b);
Expr operator!=(const Expr& a, const Expr& b);
Expr both(const Expr& a, const Expr& b);
Expr either(const Expr& a, const Expr& b);
Expr inverse(const Expr& a);
Expr exponential(const Expr& a);

struct Statement;
using Block = std::vector<Statement>;

/// Appends statements.
Block& operator+=(Block& block, Block more);

struct Assignment {
    Expr target, value;
};

struct Decision {
    Expr condition;
    Block then, otherwise;
};

/// `index` runs from 0 to count - 1.
struct Repetition {
    Expr index;
    int count = 0;
    Block body;
};

/// A comment above the statements that it explains.
struct Remark {
    std::string text;
};

struct Statement {
    std::variant<Assignment, Decision, Repetition, Remark> what;
};

Statement assign(const Expr& target, const Expr& value);
Statement when(const Expr& condition, Block then, Block otherwise = {});
Statement repeat(const Expr& index, int count, Block body);
Statement remark(std::string text);
/// Two decisions that keep x, a variable, from `low` to `high`.
void keep_within(Block& block, const Expr& x, const Expr& low, const Expr& high);

struct Program {
    std::string name = "pid";              ///< of its type in the languages: lower case, one word
    std::string title = "PID controller";  ///< for the reader
    std::vector<std::string> notes;        ///< paragraphs for the reader: what it computes and how
    std::vector<Declaration> variables;
    Block body;
    /// Sentences of an integer output, by its values; and states that are a row of a record, each with its heading.
    std::string coded_output = {};
    std::vector<std::pair<int, std::string>> codes = {};
    std::vector<std::pair<std::string, std::string>> row = {};

    /// The variable as an expression. Throws std::logic_error for a name that is already used, that of the program
    /// included; case does not count.
    Expr declare(Declaration declaration);
};

std::vector<Declaration> of_role(const Program& program, VariableRole role);

}  // namespace tunewright::code
