// Writes a controller's program as source text: IEC 61131-3 Structured Text, C11 or Python 3.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

enum class Language { structured_text, c, python };

/// What the head comment says of where the controller comes from, a line each: {"Ms", "1.4"}. Any text is safe: what a
/// comment cannot hold is replaced.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// The whole file. The program is a function block, a struct with two functions, or a class; nothing beside it is kept,
/// nothing is allocated in a call. Numbers read back as the very double that they are.
std::string print(const Program& program, Language language, const Provenance& provenance);

// ---- for those who add a language ------------------------------------------------------------------------------

/// The words and marks of one language. Lines come without indentation and line end.
class Dialect {
public:
    virtual ~Dialect() = default;

    virtual std::string real(double value) const = 0;
    virtual std::string boolean(bool value) const = 0;
    virtual std::string variable(const VariableReference& place) const = 0;
    /// Between two operands with its blanks (" + "), or before the one ("-").
    virtual std::string mark(Operation operation) const = 0;
    virtual std::string exponential(const std::string& argument) const = 0;

    virtual std::string assign(const std::string& target, const std::string& value) const = 0;
    virtual std::string open_decision(const std::string& condition) const = 0;
    virtual std::string otherwise() const = 0;
    virtual std::string open_repetition(const std::string& index, int count) const = 0;
    virtual std::string close_decision() const = 0;    ///< "": the indentation ends it
    virtual std::string close_repetition() const = 0;  ///< the same
    virtual std::string remark(const std::string& text) const = 0;
};

/// Each operation stands as it was built: parentheses where left to right or the order of precedence would change it.
std::string text_of(const Expr& expression, const Dialect& dialect);

/// Lines with their ends, from `depth` steps of four blanks on.
std::string text_of(const Block& block, const Dialect& dialect, int depth);

/// The shortest decimal that reads back as `value`, always with a point: "10.0", "1.0e-5".
std::string real_literal(double value, char exponent);

/// The head comment's lines, without marks of comments: provenance, settings, notes, and how the program is called.
std::vector<std::string> head_lines(const Program& program, const Provenance& provenance,
                                    const std::vector<std::string>& call);

std::string indentation(int depth);

std::vector<Declaration> of_role(const Program& program, VariableRole role);

/// A setting that the user may write, for the words on how: Kp, or a limit where the program computes Kp itself.
std::string example_setting(const Program& program);

/// What the call in the comment is given for each input, joined by commas: `argument` of each declaration.
std::string example_arguments(const Program& program, const std::function<std::string(const Declaration&)>& argument);

// One printer a language, each in its source.
std::string print_structured_text(const Program& program, const Provenance& provenance);
std::string print_c(const Program& program, const Provenance& provenance);
std::string print_python(const Program& program, const Provenance& provenance);

}  // namespace tunewright::code
