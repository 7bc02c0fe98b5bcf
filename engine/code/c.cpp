#include <fmt/format.h>

#include <cctype>
#include <cstdint>

#include "engine/code/print.h"

namespace tunewright::code {
namespace {

class C : public Dialect {
public:
    explicit C(const Program& program)
        : Dialect({" == ", " != ", " && ", " || ", "!"}),
          record_(program.name),
          kept_outputs_(of_role(program, VariableRole::output).size() > 1) {}

    std::string real(double value) const override { return real_literal(value, 'e'); }
    std::string boolean(bool value) const override { return value ? "true" : "false"; }
    std::string variable(const VariableReference& place) const override {
        const bool field = place.role == VariableRole::parameter || place.role == VariableRole::state ||
                           (place.role == VariableRole::output && kept_outputs_);
        return field ? record_ + "->" + place.name : place.name;
    }
    std::string exponential(const std::string& argument) const override { return "exp(" + argument + ")"; }
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

    bool keeps_outputs() const { return kept_outputs_; }

private:
    std::string record_;
    bool kept_outputs_;  // a function returns one value: several outputs are fields
};

const char* type_text(Type type) { return type == Type::real ? "double " : type == Type::boolean ? "bool " : "int "; }

std::string field(const Declaration& variable) {
    const std::string length = variable.length > 0 ? "[" + std::to_string(variable.length) + "]" : "";
    return indentation(1) + type_text(variable.type) + variable.name + length + "; /* " + variable.comment + " */\n";
}

std::string initial(const Declaration& variable, const Program& program) {
    const C c(program);
    const std::string place = indentation(1) + c.variable({variable.role, variable.name});
    const std::string value = variable.type == Type::real      ? c.real(variable.initial)
                              : variable.type == Type::boolean ? c.boolean(variable.initial != 0)
                                                               : "0";
    if (variable.length == 0) return place + " = " + value + ";\n";
    return indentation(1) + "for (int k = 0; k < " + std::to_string(variable.length) + "; ++k) {\n" + indentation(1) +
           place + "[k] = " + value + ";\n" + indentation(1) + "}\n";
}

void add_struct(const Program& program, std::string& out) {
    out += "typedef struct {\n    /* Settings. */\n";
    for (const Declaration& variable : of_role(program, VariableRole::parameter)) out += field(variable);
    out += "\n    /* Memory; do not write to it. */\n";
    for (const Declaration& variable : of_role(program, VariableRole::state)) out += field(variable);
    if (C(program).keeps_outputs()) {
        out += "\n    /* Outputs of the last call. */\n";
        for (const Declaration& variable : of_role(program, VariableRole::output)) out += field(variable);
    }
    out += "} tunewright_" + program.name + ";\n\n";
}

void add_init(const Program& program, std::string& out) {
    out += "/* Sets the tuned settings; the next call is the first one. */\n";
    const std::string type = "tunewright_" + program.name;
    out += "static inline void " + type + "_init(" + type + " *" + program.name + ")\n{\n";
    for (const VariableRole role : {VariableRole::parameter, VariableRole::state})
        for (const Declaration& variable : of_role(program, role)) out += initial(variable, program);
    out += "}\n\n";
}

void add_step(const Program& program, std::string& out) {
    const C c(program);
    const std::string type = "tunewright_" + program.name;
    out += c.keeps_outputs() ? "/* One call every Ts seconds; the outputs are fields. */\nstatic inline void "
                             : "/* One call every Ts seconds; the answer is u. */\nstatic inline double ";
    out += type + "_step(\n    " + type + " *" + program.name;
    for (const Declaration& variable : of_role(program, VariableRole::input))
        out += std::string(", ") + type_text(variable.type) + variable.name;
    out += ")\n{\n";
    for (const VariableRole role : {VariableRole::local, VariableRole::output})
        for (const Declaration& variable : of_role(program, role))
            if (role == VariableRole::local || !c.keeps_outputs()) out += field(variable);
    out += "\n" + text_of(program.body, c, 1);
    if (!c.keeps_outputs()) out += "    return " + output_names(program) + ";\n";
    out += "}\n";
}

bool uses_exponential(const std::string& text) { return text.find("exp(") != text.npos; }

/// The same text may be included twice. Another program with the same names must not be ignored silently: its loop
/// would then run with the first one's settings.
std::string open_guard(const Program& program, const std::string& functions) {
    std::uint64_t sum = 0xcbf29ce484222325;  // FNV-1a, 64 bits (Fowler, Noll and Vo, 1991)
    for (const unsigned char byte : functions) sum = (sum ^ byte) * 0x100000001b3;
    std::string any = "TUNEWRIGHT_" + program.name + "_";
    for (char& letter : any) letter = static_cast<char>(std::toupper(letter));
    const std::string own = fmt::format("{}{:016X}", any, sum);
    return "#ifndef " + own + "\n#define " + own + "\n#ifdef " + any + "H\n" +
           "#error \"Two programs of Tunewright in one source: include each in its own source, or keep one and set the "
           "other loop's settings after tunewright_" +
           program.name + "_init.\"\n#endif\n#define " + any + "H\n\n";
}

/// The sentences of a coded output.
void add_sentences(const Program& program, std::string& out) {
    if (program.codes.empty()) return;
    out += "\n/* The sentence of a value of " + program.coded_output + ". */\nstatic inline const char *tunewright_" +
           program.name + "_" + program.coded_output + "(int value)\n{\n    switch (value) {\n";
    for (const auto& [value, sentence] : program.codes)
        out += "    case " + std::to_string(value) + ": return \"" + sentence + "\";\n";
    out += "    default: return \"\";\n    }\n}\n";
}

void add_row(const Program& program, std::string& out) {
    if (program.row.empty()) return;
    const std::string type = "tunewright_" + program.name;
    std::string format, values;
    for (const auto& [state, heading] : program.row) {
        format += (format.empty() ? "" : ",") + std::string("%.10g");
        values += ", " + program.name + "->" + state;
    }
    out += "\n/* A row of the record, \"" + row_headings(program) +
           "\", with its line end; the answer is that of snprintf. */\n" + "static inline int " + type + "_row(const " +
           type + " *" + program.name + ", char *text, size_t size)\n{\n    return snprintf(text, size, \"" + format +
           "\\n\"" + values + ");\n}\n";
}

}  // namespace

std::string c_argument(const Declaration& input) {
    if (!input.optional) return input.name;
    return input.type != Type::boolean ? real_literal(input.initial, 'e') : input.initial != 0 ? "true" : "false";
}

std::string c_functions(const Program& program, bool rows) {
    std::string out;
    add_struct(program, out);
    add_init(program, out);
    add_step(program, out);
    add_sentences(program, out);
    if (rows) add_row(program, out);
    return out;
}

std::string c_head(const Program& program, const Provenance& provenance, const std::vector<std::string>& call) {
    std::string head = "/*\n";
    for (const std::string& line : head_lines(program, provenance, call))
        head += line.empty() ? " *\n" : " * " + line + "\n";
    return head + " */\n";
}

std::string print_c(const Program& program, const Provenance& provenance) {
    const std::string type = "tunewright_" + program.name;
    const bool keeps_outputs = C(program).keeps_outputs();
    const std::vector<std::string> call{"Call, for each controller:",
                                        "    " + type + " " + program.name + ";",
                                        "    " + type + "_init(&" + program.name + ");",
                                        "and then every Ts seconds:",
                                        std::string("    ") + (keeps_outputs ? "" : "u = ") + type + "_step(&" +
                                            program.name + ", " + example_arguments(program, c_argument) + ");",
                                        std::string("Settings ") + (keeps_outputs ? "and outputs " : "") +
                                            "are fields of the struct: " + program.name + "." +
                                            example_setting(program) + " = 2.0;"};
    const std::string functions = c_functions(program, true);
    std::string includes = uses_exponential(functions) ? "#include <math.h>\n" : "";
    includes += "#include <stdbool.h>\n";
    if (!program.row.empty()) includes += "#include <stdio.h>\n";
    return c_head(program, provenance, call) + open_guard(program, functions) + includes + "\n" + functions +
           "\n#endif\n";
}

}  // namespace tunewright::code
