#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "engine/code/print.h"

namespace tunewright::code {
namespace {

class C : public Dialect {
public:
    std::string real(double value) const override { return real_literal(value, 'e'); }
    std::string boolean(bool value) const override { return value ? "true" : "false"; }
    std::string variable(const VariableReference& place) const override {
        const bool field = place.role == VariableRole::parameter || place.role == VariableRole::state;
        return field ? "pid->" + place.name : place.name;
    }
    std::string exponential(const std::string& argument) const override { return "exp(" + argument + ")"; }
    std::string mark(Operation operation) const override {
        switch (operation) {
            case Operation::add: return " + ";
            case Operation::subtract: return " - ";
            case Operation::multiply: return " * ";
            case Operation::divide: return " / ";
            case Operation::less: return " < ";
            case Operation::greater: return " > ";
            case Operation::greater_equal: return " >= ";
            case Operation::not_equal: return " != ";
            case Operation::logical_and: return " && ";
            case Operation::logical_or: return " || ";
            case Operation::negate: return "-";
            case Operation::logical_not: return "!";
            case Operation::exponential: break;
        }
        return {};
    }

    std::string assign(const std::string& target, const std::string& value) const override {
        return target + " = " + value + ";";
    }
    std::string open_decision(const std::string& condition) const override { return "if (" + condition + ") {"; }
    std::string otherwise() const override { return "} else {"; }
    std::string open_repetition(const std::string& index, int count) const override {
        return "for (" + index + " = 0; " + index + " < " + std::to_string(count) + "; ++" + index + ") {";
    }
    std::string close_decision() const override { return "}"; }
    std::string close_repetition() const override { return "}"; }
    std::string remark(const std::string& text) const override { return "/* " + text + " */"; }
};

const char* type_text(Type type) { return type == Type::real ? "double " : type == Type::boolean ? "bool " : "int "; }

std::string field(const Declaration& variable) {
    const std::string length = variable.length > 0 ? "[" + std::to_string(variable.length) + "]" : "";
    return indentation(1) + type_text(variable.type) + variable.name + length + "; /* " + variable.comment + " */\n";
}

std::string initial(const Declaration& variable) {
    const C c;
    const std::string value = variable.type == Type::real      ? c.real(variable.initial)
                              : variable.type == Type::boolean ? c.boolean(variable.initial != 0)
                                                               : "0";
    if (variable.length == 0) return indentation(1) + "pid->" + variable.name + " = " + value + ";\n";
    return indentation(1) + "for (int k = 0; k < " + std::to_string(variable.length) + "; ++k) {\n" + indentation(2) +
           "pid->" + variable.name + "[k] = " + value + ";\n" + indentation(1) + "}\n";
}

void add_struct(const Program& program, std::string& out) {
    out += "typedef struct {\n    /* Settings. */\n";
    for (const Declaration& variable : of_role(program, VariableRole::parameter)) out += field(variable);
    out += "\n    /* Memory; do not write to it. */\n";
    for (const Declaration& variable : of_role(program, VariableRole::state)) out += field(variable);
    out += "} tunewright_pid;\n\n";
}

void add_init(const Program& program, std::string& out) {
    out += "/* Sets the tuned settings; the next call is the first one. */\n";
    out += "static inline void tunewright_pid_init(tunewright_pid *pid)\n{\n";
    for (const VariableRole role : {VariableRole::parameter, VariableRole::state})
        for (const Declaration& variable : of_role(program, role)) out += initial(variable);
    out += "}\n\n";
}

void add_step(const Program& program, std::string& out) {
    out += "/* One call every Ts seconds; the answer is u. */\n";
    out += "static inline double tunewright_pid_step(\n    tunewright_pid *pid";
    for (const Declaration& variable : of_role(program, VariableRole::input))
        out += std::string(", ") + type_text(variable.type) + variable.name;
    out += ")\n{\n";
    for (const VariableRole role : {VariableRole::local, VariableRole::output})
        for (const Declaration& variable : of_role(program, role)) out += field(variable);
    out += "\n" + text_of(program.body, C(), 1) + "    return " + of_role(program, VariableRole::output).front().name +
           ";\n}\n";
}

bool uses_exponential(const std::string& text) { return text.find("exp(") != text.npos; }

/// The same text may be included twice. Another program with the same names must not be ignored silently: its loop
/// would then run with the first one's settings.
std::string open_guard(const std::string& functions) {
    std::uint64_t sum = 0xcbf29ce484222325;  // FNV-1a, 64 bits (Fowler, Noll and Vo, 1991)
    for (const unsigned char byte : functions) sum = (sum ^ byte) * 0x100000001b3;
    const std::string own = fmt::format("TUNEWRIGHT_PID_{:016X}", sum);
    return "#ifndef " + own + "\n#define " + own + "\n#ifdef TUNEWRIGHT_PID_H\n" +
           "#error \"Two programs of Tunewright in one source: include each in its own source, or keep one and set the "
           "other loop's settings after tunewright_pid_init.\"\n#endif\n#define TUNEWRIGHT_PID_H\n\n";
}

std::string c_argument(const Declaration& input) {
    return input.name == "manual" ? "false" : input.name == "manual_output" ? "0.0" : input.name;
}

}  // namespace

std::string print_c(const Program& program, const Provenance& provenance) {
    const std::vector<std::string> call{
        "Call, for each controller:",
        "    tunewright_pid pid;",
        "    tunewright_pid_init(&pid);",
        "and then every Ts seconds:",
        "    u = tunewright_pid_step(&pid, " + example_arguments(program, c_argument) + ");",
        "Settings are fields of the struct: pid." + example_setting(program) + " = 2.0;"};
    std::string head = "/*\n";
    for (const std::string& line : head_lines(program, provenance, call))
        head += line.empty() ? " *\n" : " * " + line + "\n";
    std::string functions;
    add_struct(program, functions);
    add_init(program, functions);
    std::string step;
    add_step(program, step);
    functions += step;
    const char* math = uses_exponential(step) ? "#include <math.h>\n" : "";
    return head + " */\n" + open_guard(functions) + math + "#include <stdbool.h>\n\n" + functions + "\n#endif\n";
}

}  // namespace tunewright::code
