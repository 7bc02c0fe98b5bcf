#include <cctype>

#include "engine/code/print.h"

namespace tunewright::code {
namespace {

class Python : public Dialect {
public:
    Python() : Dialect({" == ", " != ", " and ", " or ", "not "}) {}

    std::string real(double value) const override { return real_literal(value, 'e'); }
    std::string boolean(bool value) const override { return value ? "True" : "False"; }
    std::string variable(const VariableReference& place) const override {
        const bool field = place.role == VariableRole::parameter || place.role == VariableRole::state;
        return field ? "self." + place.name : place.name;
    }
    std::string exponential(const std::string& argument) const override { return "math.exp(" + argument + ")"; }
    std::string assign(const std::string& target, const std::string& value) const override {
        return target + " = " + value;
    }
    std::string open_decision(const std::string& condition) const override { return "if " + condition + ":"; }
    std::string otherwise() const override { return "else:"; }
    std::string open_repetition(const std::string& index, int count) const override {
        return "for " + index + " in range(" + std::to_string(count) + "):";
    }
    std::string close_decision() const override { return {}; }
    std::string close_repetition() const override { return {}; }
    std::string remark(const std::string& text) const override { return "# " + text; }
};

std::string initial_value(const Declaration& variable) {
    const Python python;
    return variable.type == Type::real      ? python.real(variable.initial)
           : variable.type == Type::boolean ? python.boolean(variable.initial != 0)
                                            : "0";
}

std::string attribute(const Declaration& variable) {
    std::string value = initial_value(variable);
    if (variable.length > 0) value = "[" + value + "] * " + std::to_string(variable.length);
    return indentation(2) + "self." + variable.name + " = " + value + "  # " + variable.comment + "\n";
}

std::string python_argument(const Declaration& input) {
    return input.optional ? input.name + "=" + initial_value(input) : input.name;
}

std::string arguments(const Program& program) {
    std::string out = "self";
    for (const Declaration& variable : of_role(program, VariableRole::input)) out += ", " + python_argument(variable);
    return out;
}

/// The sentences of a coded output.
std::string sentences(const Program& program) {
    if (program.codes.empty()) return {};
    std::string out;
    for (const char c : program.coded_output) out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    out += "S = {\n";
    for (const auto& [value, sentence] : program.codes)
        out += "    " + std::to_string(value) + ": \"" + sentence + "\",\n";
    return out + "}\n\n\n";
}

std::string row_method(const Program& program) {
    if (program.row.empty()) return {};
    std::string format, values;
    for (const auto& [state, heading] : program.row) {
        format += (format.empty() ? "" : ",") + std::string("%.10g");
        values += (values.empty() ? "self." : ", self.") + state;
    }
    return "\n    def row(self):\n        \"\"\"A row of the record, " + row_headings(program) +
           ", without a line end.\"\"\"\n        return \"" + format + "\" % (" + values + ")\n";
}

}  // namespace

std::string print_python(const Program& program, const Provenance& provenance) {
    const std::vector<std::string> call{
        "Call, for each controller:", "    " + program.name + " = " + type_name(program) + "()",
        "and then every Ts seconds:",
        "    " + output_names(program) + " = " + program.name + ".step(" + example_arguments(program, python_argument) +
            ")",
        "Settings are attributes: " + program.name + "." + example_setting(program) + " = 2.0"};
    std::string out;
    for (const std::string& line : head_lines(program, provenance, call))
        out += line.empty() ? "#\n" : "# " + line + "\n";
    const std::string body = text_of(program.body, Python(), 2);
    out += body.find("math.") == body.npos ? "\n\n" : "\nimport math\n\n\n";
    out += sentences(program);
    out += "class " + type_name(program) + ":\n    \"\"\"A sampled " + program.title +
           ".\"\"\"\n\n    def __init__(self):\n";
    for (const Declaration& variable : of_role(program, VariableRole::parameter)) out += attribute(variable);
    out += "\n        # Memory; do not write to it.\n";
    for (const Declaration& variable : of_role(program, VariableRole::state)) out += attribute(variable);
    out += "\n    def step(" + arguments(program) + "):\n        \"\"\"One call every Ts seconds; the answer is " +
           output_names(program) + ".\"\"\"\n";
    return out + body + "        return " + output_names(program) + "\n" + row_method(program);
}

}  // namespace tunewright::code
