#include <cmath>

#include "engine/code/algorithm.h"
#include "engine/code/print.h"

namespace tunewright::code {
namespace {

// C++11, as the compilers of old boards are. A double has seven digits on 8-bit boards.
const char* const kLoop = R"(
/* ---- The loop: one call every Ts seconds. ------------------------------------------------------- */

static @TYPE@ @NAME@;
static unsigned long next_call;

void setup()
{
    Serial.begin(115200);
    @TYPE@_init(&@NAME@);
    next_call = millis();
}

void loop()
{
    if ((long)(millis() - next_call) < 0) return;
    const unsigned long period = (unsigned long)(1000.0 * @NAME@.Ts + 0.5);
    next_call += period;
    if ((long)(millis() - next_call) >= 0) next_call = millis() + period; /* it was late */
@READ@    @CALL@
@WRITE@}
)";

const char* const kExperimentLoop = R"(
/* ---- The test: "s" on the serial line starts it, "x" ends it; the answer is the record. ----------- */

static @TYPE@ @NAME@;
static unsigned long next_call, began;
static bool start = false, told = false;

void setup()
{
    Serial.begin(115200);
    @TYPE@_init(&@NAME@);
    next_call = began = millis();
}

void loop()
{
    if (Serial.available() > 0) {
        const int key = Serial.read();
        if (key == 's' && !start) {
            start = true;
            told = false;
            began = millis();
            Serial.println("@HEADINGS@");
        }
        if (key == 'x') start = false;
    }
    if ((long)(millis() - next_call) < 0) return;
    const unsigned long period = (unsigned long)(1000.0 * @NAME@.Ts + 0.5);
    next_call += period;
    if ((long)(millis() - next_call) >= 0) next_call = millis() + period; /* it was late */
@READ@    const double now = (double)(millis() - began) / 1000.0;
    @CALL@
@WRITE@    if (@NAME@.recording) {
@ROW@
    }
    if (@NAME@.mode >= 4 && !told) {
        Serial.print("# ");
        Serial.println(@TYPE@_reason(@NAME@.reason));
        told = true;
    }
}
)";

std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& words) {
    for (const auto& [mark, word] : words)
        for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + word.size()))
            text.replace(at, mark.size(), word);
    return text;
}

/// The inputs that a call must give, apart from `start`, which the sketch has itself.
std::vector<std::string> read_inputs(const Program& program) {
    std::vector<std::string> out;
    for (const Declaration& input : of_role(program, VariableRole::input))
        if (!input.optional && input.type == Type::real) out.push_back(input.name);
    return out;
}

std::vector<std::string> written_outputs(const Program& program) {
    std::vector<std::string> out;
    for (const Declaration& output : of_role(program, VariableRole::output))
        if (output.type == Type::real) out.push_back(output.name);
    return out;
}

double setting_of(const Program& program, const char* name, double otherwise) {
    for (const Declaration& setting : of_role(program, VariableRole::parameter))
        if (setting.name == name && std::abs(setting.initial) < kNoLimit) return setting.initial;
    return otherwise;
}

/// u of a board whose owner has not yet said which: the safe value, else the least u, else 0.
double resting_output(const Program& program) { return setting_of(program, "u_safe", setting_of(program, "u_min", 0)); }

/// A function for each signal, with an example of its hardware: measurements at the analogue pins, in percent.
std::string signals(const Program& program) {
    std::string out =
        "\n/* ---- Your hardware: replace what these functions do; units are those of the settings. -------------- "
        "*/\n";
    int pin = 0;
    for (const std::string& input : read_inputs(program)) {
        const std::string value = input == "u_controller" ? real_literal(resting_output(program), 'e')
                                  : input.starts_with("setpoint")
                                      ? "50.0"
                                      : "analogRead(A" + std::to_string(pin++) + ") * (100.0 / 1023.0)";
        out += "\nstatic double read_" + input + "()\n{\n    return " + value + ";\n}\n";
    }
    pin = 9;
    for (const std::string& output : written_outputs(program))
        out += "\nstatic void write_" + output + "(double value)\n{\n    analogWrite(" + std::to_string(pin++) +
               ", (int)(value * (255.0 / " + real_literal(setting_of(program, "u_max", 100), 'e') + ") + 0.5));\n}\n";
    return out;
}

std::string read_statements(const Program& program) {
    std::string out;
    for (const std::string& input : read_inputs(program))
        out += "    const double " + input + " = read_" + input + "();\n";
    return out;
}

std::string write_statements(const Program& program) {
    const bool fields = of_role(program, VariableRole::output).size() > 1;
    std::string out;
    for (const std::string& output : written_outputs(program))
        out += "    write_" + output + "(" + (fields ? program.name + "." : "") + output + ");\n";
    return out;
}

/// Six decimals, so that slow drifts are not lost; the last value ends the line.
std::string row_statements(const Program& program) {
    std::string out;
    for (std::size_t i = 0; i < program.row.size(); ++i) {
        const std::string value = program.name + "." + program.row[i].first;
        const bool last = i + 1 == program.row.size();
        out += std::string(i == 0 ? "" : "\n") + "        Serial." + (last ? "println(" : "print(") + value + ", 6);";
        if (!last) out += "\n        Serial.print(',');";
    }
    return out;
}

std::string argument(const Declaration& input) { return input.name == "now" ? input.name : c_argument(input); }

}  // namespace

std::string print_arduino(const Program& program, const Provenance& provenance) {
    const std::string type = "tunewright_" + program.name, functions = c_functions(program, false);
    const std::vector<std::string> call{
        "A sketch: put this text into a folder of the same name, fill in the functions for your hardware, upload it.",
        "Settings are fields of the struct: " + program.name + "." + example_setting(program) + " = 2.0;"};
    const bool experiment = !program.row.empty();
    const bool one = of_role(program, VariableRole::output).size() == 1;  // it is the answer of the call
    const std::string step = std::string(one ? "const double u = " : "") + type + "_step(&" + program.name + ", " +
                             example_arguments(program, argument) + ");";
    return c_head(program, provenance, call) + "#include <math.h>\n#include <stdbool.h>\n\n" + functions +
           signals(program) +
           filled(experiment ? kExperimentLoop : kLoop, {{"@TYPE@", type},
                                                         {"@NAME@", program.name},
                                                         {"@CALL@", step},
                                                         {"@HEADINGS@", row_headings(program)},
                                                         {"@ROW@", row_statements(program)},
                                                         {"@READ@", read_statements(program)},
                                                         {"@WRITE@", write_statements(program)}});
}

}  // namespace tunewright::code
