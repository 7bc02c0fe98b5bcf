#include <cctype>
#include <utility>

#include "engine/code/print.h"

namespace tunewright::code {
namespace {

class StructuredText : public Dialect {
public:
    StructuredText() : Dialect({" = ", " <> ", " AND ", " OR ", "NOT "}) {}

    std::string real(double value) const override { return real_literal(value, 'E'); }
    std::string boolean(bool value) const override { return value ? "TRUE" : "FALSE"; }
    std::string variable(const VariableReference& place) const override { return place.name; }
    std::string exponential(const std::string& argument) const override { return "EXP(" + argument + ")"; }
    std::string assign(const std::string& target, const std::string& value) const override {
        return target + " := " + value + ";";
    }
    std::string open_decision(const std::string& condition) const override { return "IF " + condition + " THEN"; }
    std::string otherwise() const override { return "ELSE"; }
    std::string open_repetition(const std::string& index, int count) const override {
        return "FOR " + index + " := 0 TO " + std::to_string(count - 1) + " DO";
    }
    std::string close_decision() const override { return "END_IF;"; }
    std::string close_repetition() const override { return "END_FOR;"; }
    std::string remark(const std::string& text) const override { return "(* " + text + " *)"; }
};

std::string type_text(const Declaration& variable) {
    const char* type = variable.type == Type::real ? "LREAL" : variable.type == Type::boolean ? "BOOL" : "INT";
    if (variable.length == 0) return type;
    return "ARRAY[0.." + std::to_string(variable.length - 1) + "] OF " + type;
}

std::string initial_text(const Declaration& variable) {
    if (variable.role == VariableRole::local || variable.role == VariableRole::output || variable.length > 0) return {};
    if (variable.type == Type::real) return " := " + real_literal(variable.initial, 'E');
    if (variable.type == Type::boolean) return variable.initial != 0 ? " := TRUE" : " := FALSE";
    return " := 0";
}

void add_section(const char* section, const std::vector<Declaration>& variables, std::string& out) {
    out += std::string(section) + "\n";
    for (const Declaration& variable : variables)
        out += indentation(1) + variable.name + " : " + type_text(variable) + initial_text(variable) + "; (* " +
               variable.comment + " *)\n";
    out += "END_VAR\n";
}

std::string text_argument(const Declaration& input) {
    static const std::pair<const char*, const char*> kShort[] = {
        {"setpoint", "SP"}, {"measurement", "PV"}, {"scheduling", "PLACE"}, {"disturbance", "DV"}};
    if (input.optional) return input.name + initial_text(input);
    std::string value = input.name;
    for (const auto& [word, tag] : kShort)
        if (const auto at = value.find(word); at != value.npos) value.replace(at, std::string(word).size(), tag);
    for (char& c : value) c = static_cast<char>(std::toupper(c));
    return input.name + " := " + value;
}

}  // namespace

std::string print_structured_text(const Program& program, const Provenance& provenance) {
    const std::vector<std::string> call{
        "Call, once a cycle in a task whose period is Ts, with an instance heater : " + type_name(program) + ";",
        "    heater(" + example_arguments(program, text_argument) + ");",
        "    OUT := heater." + of_role(program, VariableRole::output).front().name + ";",
        "Settings are inputs with initial values; they are given in the same way: heater(" + example_setting(program) +
            " := 2.0, ...)."};
    std::string out = "(*\n";
    for (const std::string& line : head_lines(program, provenance, call))
        out += line.empty() ? "\n" : "  " + line + "\n";
    out += "*)\nFUNCTION_BLOCK " + type_name(program) + "\n";
    std::vector<Declaration> inputs = of_role(program, VariableRole::input);
    const std::vector<Declaration> settings = of_role(program, VariableRole::parameter);
    inputs.insert(inputs.end(), settings.begin(), settings.end());
    add_section("VAR_INPUT", inputs, out);
    add_section("VAR_OUTPUT", of_role(program, VariableRole::output), out);
    add_section("VAR", of_role(program, VariableRole::state), out);
    add_section("VAR_TEMP", of_role(program, VariableRole::local), out);
    return out + "\n" + text_of(program.body, StructuredText(), 0) + "END_FUNCTION_BLOCK\n";
}

}  // namespace tunewright::code
