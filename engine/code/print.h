// Writes a controller's program as source text: IEC 61131-3 Structured Text, C11, Python 3 or a sketch for an Arduino.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

enum class Language { structured_text, c, python, arduino };

/// The origin of the controller for the head comment, a line each: {"Ms", "1.4"}. Any text is safe: characters that a
/// comment cannot contain are replaced.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// The whole file. The program is a function block, a struct with two functions, or a class; it keeps no other state,
/// and a call allocates nothing. Numbers read back as exactly the same double.
std::string print(const Program& program, Language language, const Provenance& provenance);

// ---- for a new language --------- ------------------------------------------------------------------------------

/// The syntax of one language. Lines come without indentation and line end.
class Dialect {
public:
    /// The words that languages have in different ways, with their blanks.
    struct Words {
        const char *equal, *not_equal, *logical_and, *logical_or, *logical_not;
    };
    explicit Dialect(const Words& words) : words_(words) {}
    virtual ~Dialect() = default;

    virtual std::string real(double value) const = 0;
    virtual std::string boolean(bool value) const = 0;
    /// The name alone, or with the record that keeps it.
    virtual std::string variable(const VariableReference& place) const = 0;
    /// The operator with blanks between two operands (" + "), or before a single one ("-").
    std::string mark(Operation operation) const;
    virtual std::string exponential(const std::string& argument) const = 0;

    virtual std::string assign(const std::string& target, const std::string& value) const = 0;
    virtual std::string open_decision(const std::string& condition) const = 0;
    virtual std::string otherwise() const = 0;
    virtual std::string open_repetition(const std::string& index, int count) const = 0;
    virtual std::string close_decision() const = 0;    ///< "": the indentation ends the block
    virtual std::string close_repetition() const = 0;  ///< the same
    virtual std::string remark(const std::string& text) const = 0;

private:
    Words words_;
};

/// The expression with the tree's order of operations: parentheses where precedence or left-to-right order would change
/// it.
std::string text_of(const Expr& expression, const Dialect& dialect);

/// The block's lines with line ends, indented by `depth` steps of four blanks.
std::string text_of(const Block& block, const Dialect& dialect, int depth);

/// The shortest decimal that reads back as `value`, always with a point: "10.0", "1.0e-5".
std::string real_literal(double value, char exponent);

/// The head comment's lines, without marks of comments: provenance, settings, notes, and an example call.
std::vector<std::string> head_lines(const Program& program, const Provenance& provenance,
                                    const std::vector<std::string>& call);

std::string indentation(int depth);

/// The program's type: its name in capitals at the beginning, "TunewrightPid".
std::string type_name(const Program& program);

/// The names of the outputs, joined by commas.
std::string output_names(const Program& program);

/// A setting that the user may write, for the example: Kp, or a limit if the program has no Kp or computes it itself.
std::string example_setting(const Program& program);

/// The arguments of the example call, one for each input, joined by commas: `argument` of each declaration.
std::string example_arguments(const Program& program, const std::function<std::string(const Declaration&)>& argument);

// One function per language, each in its own source.
std::string print_structured_text(const Program& program, const Provenance& provenance);
std::string print_c(const Program& program, const Provenance& provenance);
std::string print_python(const Program& program, const Provenance& provenance);
std::string print_arduino(const Program& program, const Provenance& provenance);

/// The type and the functions in C, which C++11 compiles too, without the head and the guard. `rows`: with the function
/// that formats a row of the record, which needs a library with snprintf for numbers.
std::string c_functions(const Program& program, bool rows);
/// `call`: how to call it, for the head.
std::string c_head(const Program& program, const Provenance& provenance, const std::vector<std::string>& call);
/// An input of the example call: its name, or for one that may be left out its initial value.
std::string c_argument(const Declaration& input);

/// The headings of a row of the record: "t,u,y".
std::string row_headings(const Program& program);

}  // namespace tunewright::code
