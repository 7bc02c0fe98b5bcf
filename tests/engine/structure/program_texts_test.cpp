// The texts of structures' programs in C, Python and Structured Text compute what the interpreter does.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "engine/code/interpreter.h"
#include "engine/code/print.h"
#include "engine/number_text.h"
#include "engine/structure/program/loop_programs.h"
#include "engine/structure/program/predictor_program.h"
#include "tests/engine/structure/plants.h"
#include "tests/test_data.h"

namespace tunewright::structure {
namespace {

constexpr int kCalls = 2000;
constexpr double kCallTime = 0.5;

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? std::string("\\n") : std::string(1, c);
    }
    return out + "\"";
}

template <class Range, class Item>
std::string list(const Range& range, const Item& item) {
    std::string out;
    for (const auto& value : range) out += (out.empty() ? "[" : ", ") + item(value);
    return out.empty() ? "[]" : out + "]";
}

std::vector<std::string> names(const std::vector<code::Declaration>& variables) {
    std::vector<std::string> out;
    for (const auto& variable : variables) out.push_back(variable.name);
    return out;
}

/// Hard inputs: noise, steps, manual phases and changes of mode; most programs are at a limit for a part of the calls.
double value_of(const code::Declaration& input, int k, std::mt19937& engine) {
    const int place = static_cast<int>(input.name.size());  // so that inputs do not change together
    if (input.type == code::Type::boolean) return (k / (90 + place)) % 5 == 2 ? 1 - input.initial : input.initial;
    if (input.optional) return 30 + 25 * std::sin(0.01 * k * place);
    return 20 + 12 * ((k / (70 + 5 * place)) % 3) + std::normal_distribution<>(0, 0.5)(engine);
}

void write(const std::filesystem::path& folder, const std::string& file, const Expected<code::Program>& program) {
    ASSERT_TRUE(program) << file << ": " << program.error().message;
    code::Interpreter machine(*program);
    const auto inputs = code::of_role(*program, code::VariableRole::input),
               outputs = code::of_role(*program, code::VariableRole::output);
    std::mt19937 engine(11);
    std::vector<std::vector<double>> rows, expected;
    for (int k = 0; k < kCalls; ++k) {
        rows.emplace_back();
        for (const auto& input : inputs) rows.back().push_back(machine[input.name] = value_of(input, k, engine));
        machine.call();
        expected.emplace_back();
        for (const auto& output : outputs) expected.back().push_back(machine[output.name]);
        for (const double u : expected.back()) ASSERT_TRUE(std::isfinite(u)) << file << " " << k;
    }
    std::vector<std::string> flags;
    for (const auto& input : inputs)
        if (input.type == code::Type::boolean) flags.push_back(input.name);
    const auto table = [](const std::vector<std::vector<double>>& lines) {
        return list(lines, [](const std::vector<double>& line) { return list(line, exact_text); });
    };
    const auto text = [&](code::Language language) {
        return quoted(code::print(*program, language, {{"Loop", file}}));
    };
    std::ofstream(folder / (file + ".json"))
        << "{\"name\": " << quoted(program->name) << ", \"inputs\": " << list(names(inputs), quoted)
        << ", \"flags\": " << list(flags, quoted) << ", \"outputs\": " << list(names(outputs), quoted)
        << ", \"rows\": " << table(rows) << ", \"expected\": " << table(expected)
        << ", \"texts\": {\"c\": " << text(code::Language::c) << ", \"python\": " << text(code::Language::python)
        << ", \"st\": " << text(code::Language::structured_text) << "}}";
}

Expected<code::Program> predictor(const PredictorModel& model, PredictorKind kind, double Ms) {
    const auto plant =
        model.integrating ? transfer({model.K}, {1, 0}, model.L) : first_order(model.K, model.T, model.L);
    const auto design = design_predictor(model, plant, {.kind = kind, .Ms = Ms}, {});
    if (!design) return design.error();
    return usual_program(design->controller, kCallTime, {.u_min = 0, .u_max = 60, .bias = 20, .y0 = 30});
}

TEST(ProgramTexts, EveryLanguageComputesWhatTheInterpreterDoes) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("tunewright-structures-" + std::to_string(std::random_device()()));
    std::filesystem::create_directories(folder);
    const SampledPid PI{.gains = to_parallel(pi(0.8, 6)), .Ts = kCallTime};
    SampledPid PID{.gains = to_parallel(IdealPid{
                       .Kp = 1.1, .Ti = 15, .Td = 3, .b = 0.7, .filter = {FilterType::measurement_second_order, 0.8}}),
                   .Ts = kCallTime};
    const code::CodeOptions narrow{.u_min = 0, .u_max = 60, .rate_limit = 20, .bias = 30};
    const code::CodeOptions clamping{.anti_windup = code::AntiWindup::clamping, .u_min = 5, .u_max = 55, .bias = 25};
    const Feedforward late{.Kf = 0.6, .Tz = 3, .Tp = 1, .Lf = 1.2};

    write(folder, "cascade", cascade_program(PI, PID, narrow, {.u_min = 0, .u_max = 50, .bias = 20, .y0 = 30}));
    write(folder, "cascade_clamping", cascade_program(PI, PI, clamping, clamping));
    write(folder, "feedforward", feedforward_program(PID, late, narrow, 20));
    write(folder, "level", level_program({.gains = {.Kp = -0.8, .Ki = -0.05}, .Ts = kCallTime}, narrow, 4, 0.2));
    write(folder, "loops", interaction_program({PI, PID}, {narrow, clamping}));
    write(folder, "loops_decoupled",
          interaction_program({PI, PID, PI}, {narrow, clamping, narrow},
                              {{std::nullopt, late, Feedforward{.Kf = -0.2}}, {late, std::nullopt, std::nullopt}, {}}));
    write(folder, "smith", predictor({.K = 2, .T = 5, .L = 3.3}, PredictorKind::smith, 1.6));
    write(folder, "filtered", predictor({.K = 2, .T = 5, .L = 3.3}, PredictorKind::filtered_smith, 1.6));
    write(folder, "integrating",
          predictor({.K = 0.2, .L = 3.3, .integrating = true}, PredictorKind::filtered_smith, 1.6));
    write(folder, "unstable", predictor({.K = 2, .T = -15, .L = 1.7}, PredictorKind::filtered_smith, 1.95));

    const std::string script = test_data("../code/structures.py");
    EXPECT_EQ(std::system(("/usr/bin/python3 '" + script + "' '" + folder.string() + "'").c_str()), 0);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace tunewright::structure
