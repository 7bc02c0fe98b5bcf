// Jin and Son (2019): settings of Tables 4, 6, 8 (the nonlinear rows), responses of Tables 5, 7, 9 (all rows), the
// optima that the rules were fitted to; compared with the printed figures and recomputed ones (tests/data/npid).
// Interpretation as in the recomputation: the derivative acts on the measurement (a pure derivative of e would cause an
// impulse in u, and an IAE of every nonlinear row 4 to 18 % below the printed one), delta_r is constant at the step's
// size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/evaluation/evaluate.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

const Json& jin_son_reference() {
    static const Json json = Json::parse(std::ifstream(test_data("npid/jin_son.json")));
    return json;
}

std::string process_of(const std::string& row) { return row.substr(0, row.find('/')); }
bool is_nonlinear(const std::string& row) { return row.find("NPID-") != row.npos; }

/// "npid_ise" for "I/NPID-ISE" and for "ise/0.5".
std::string method_of(const std::string& row) {
    for (const char* index : {"ITAE", "IAE", "ISE", "itae", "iae", "ise"})
        if (row.find(index) != row.npos) {
            std::string id = index;
            std::ranges::transform(id, id.begin(), [](char c) { return char(std::tolower(c)); });
            return "npid_" + id;
        }
    return "";
}

Plant process(const std::string& name) {
    if (name == "I") return Sopdt{.K = 1, .T1 = 10, .T2 = 1, .L = 2};
    if (name == "II") return Zpk{.K = 1, .zeros = {}, .poles = {-2.0, -1.0, -0.5}, .L = 1};
    return Zpk{.K = 0.5, .zeros = {}, .poles = {-1.0, -1.0, -0.5}, .L = 5};
}

/// As printed, because the settings follow from these.
Fopdt printed_model(const std::string& name) {
    if (name == "I") return {.K = 1, .T = 10.002, .L = 3.06};
    if (name == "II") return {.K = 1.001, .T = 2.306, .L = 2.32};
    return {.K = 1.002, .T = 2.497, .L = 6.64};
}

TunedController tuned(const std::string& method, const Plant& plant, const MethodOptions& options = {}) {
    const auto answer =
        find_method(method)->tune(TuningProblem{plant, *LinearPlant::make(plant), std::nullopt}, options, {});
    EXPECT_TRUE(answer.has_value()) << answer.error().message;
    return *answer;
}

SetpointPerformance figures(const std::string& row, std::optional<double> horizon, bool filtered = false) {
    const Json& settings = jin_son_reference()["settings"][row]["published"];
    const double Kp = settings[0], Ti = settings[1], Td = settings[2];
    const Filter filter = filtered ? Filter{FilterType::derivative, Td / 10} : Filter{};
    EvaluateOptions options;
    options.points = 0;
    options.horizon = horizon;
    const Controller controller = is_nonlinear(row)
                                      ? Controller(Npid{.Kp = Kp, .Ti = Ti, .Td = Td, .delta_r = 1, .filter = filter})
                                      : Controller(IdealPid{.Kp = Kp, .Ti = Ti, .Td = Td, .filter = filter});
    const auto evaluation = evaluate(PlantModel(process(process_of(row))), controller, options);
    EXPECT_TRUE(evaluation.has_value() && evaluation->robustness.stable) << row;
    return evaluation->performance.setpoint;
}

TEST(JinSon, SettingsOfTables4And6And8ComeOutToTheirPrintedDigits) {
    int rows = 0;
    for (const auto& [row, settings] : jin_son_reference()["settings"].items()) {
        if (!is_nonlinear(row)) continue;
        const auto answer = tuned(method_of(row), printed_model(process_of(row)));
        EXPECT_TRUE(answer.nonlinear_integral);
        EXPECT_EQ(answer.controller.filter.type, FilterType::none);
        const double got[] = {answer.controller.Kp, answer.controller.Ti, answer.controller.Td};
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(got[i], settings["published"][i].get<double>(), 6e-5) << row << " " << i;
            EXPECT_NEAR(got[i] / settings["recomputed"][i].get<double>(), 1, 1e-6) << row << " " << i;
        }
        ++rows;
    }
    EXPECT_EQ(rows, 9);
}

TEST(JinSon, ResponsesOfTables5And7And9) {
    int rows = 0;
    for (const auto& [row, r] : jin_son_reference()["responses"].items()) {
        const Json& printed = r["published"];
        const auto p = figures(row, r["horizon"].get<double>());
        EXPECT_NEAR(*p.IAE / printed["IAE"].get<double>(), 1, 3e-3) << row;
        EXPECT_NEAR(*p.IAE / r["IAE"].get<double>(), 1, 1e-4) << row << " (the printed settings have five digits)";
        if (!printed["tr"].is_null()) {
            EXPECT_NEAR(*p.rise_time_5_95 / printed["tr"].get<double>(), 1, 7e-3) << row;
        }
        EXPECT_NEAR(*p.overshoot_percent, printed["Mp"].is_null() ? 0 : printed["Mp"].get<double>(), 0.3) << row;
        EXPECT_NEAR(*p.overshoot_percent, r["Mp"].get<double>(), 0.01) << row;
        // Printed as 9.5668, an artefact of sampling: the overshoot nearly reaches the band of 2 % (1.905 % in
        // continuous time).
        if (row == "I/NPID-IAE") {
            EXPECT_NEAR(*p.settling_time, 7.6563, 0.005);
        } else if (!printed["ts"].is_null()) {
            EXPECT_NEAR(*p.settling_time / printed["ts"].get<double>(), 1, 6e-3) << row;
        }
        ++rows;
    }
    EXPECT_EQ(rows, 21);
}

TEST(JinSon, IntegralsOverALongTimeAgreeWithTheRecomputation) {
    for (const auto& [row, r] : jin_son_reference()["responses"].items()) {
        const auto p = figures(row, 300);
        EXPECT_NEAR(*p.IAE / r["IAE_300"].get<double>(), 1, 1e-4) << row;
        EXPECT_NEAR(*p.ISE / r["ISE_300"].get<double>(), 1, 1e-4) << row;
        EXPECT_NEAR(*p.ITAE / r["ITAE_300"].get<double>(), 1, 3e-4) << row;
    }
}

TEST(JinSon, AFilteredDerivativeAgreesWithTheRecomputationToo) {
    for (const auto& [row, r] : jin_son_reference()["responses"].items()) {
        const auto p = figures(row, r["horizon"].get<double>(), true);
        const Json& f = r["filtered"];
        EXPECT_NEAR(*p.IAE / f["IAE"].get<double>(), 1, 1e-4) << row;
        EXPECT_NEAR(*p.overshoot_percent, f["Mp"].get<double>(), 0.02) << row;
        if (!f["tr"].is_null()) {
            EXPECT_NEAR(*p.rise_time_5_95 / f["tr"].get<double>(), 1, 1e-3) << row;
        }
    }
}

double cost_of(const std::string& row, const LinearPlant& plant, const IdealPid& pid) {
    ResponseOptions options;
    options.settled = 1e-8;
    const auto response = simulate_npid(plant, to_parallel(pid), 1, {1, 0}, options);
    EXPECT_TRUE(response.settles) << row;
    const auto e = error_integrals(response.nodes, 1, response.error_integral_final);
    const std::string method = method_of(row);
    return method == "npid_ise" ? e.ISE : method == "npid_iae" ? e.IAE : e.ITAE;
}

Fopdt step_model_of(const std::string& row) { return {.K = 1, .T = 1, .L = std::stod(row.substr(row.find('/') + 1))}; }

TEST(JinSon, TheRulesCostWhatTheRecomputationSays) {
    for (const auto& [row, r] : jin_son_reference()["optima"].items()) {
        const Fopdt model = step_model_of(row);
        const auto answer = tuned(method_of(row), model);
        const double got[] = {answer.controller.Kp, answer.controller.Ti, answer.controller.Td};
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(got[i] / r["rule"][i].get<double>(), 1, 1e-6) << row << " " << i;
        EXPECT_NEAR(cost_of(row, *LinearPlant::make(model), answer.controller) / r["J_rule"].get<double>(), 1, 1e-3)
            << row;
    }
}

TEST(JinSon, OptimisedSettingsCostNoMoreThanTheKnownOptima) {
    MethodOptions options;
    options.set("optimise", true);
    int found = 0;
    for (const auto& [row, r] : jin_son_reference()["optima"].items()) {
        const Fopdt model = step_model_of(row);
        const auto answer = tuned(method_of(row), model, options);
        EXPECT_LE(cost_of(row, *LinearPlant::make(model), answer.controller), 1.0002 * r["J"].get<double>()) << row;
        EXPECT_NEAR(answer.controller.Kp / r["KKp"].get<double>(), 1, 0.02) << row;
        EXPECT_TRUE(answer.warnings.empty()) << row;
        ++found;
    }
    EXPECT_EQ(found, 66);
}

TEST(JinSon, BetweenItsTablesTheLaterOneIsUsedForItCostsLess) {
    for (const auto& [row, r] : jin_son_reference()["gap"].items()) {
        EXPECT_LT(r["ratio_table3"].get<double>(), r["ratio_table2"].get<double>()) << row;
        const Fopdt model = step_model_of(row);
        const auto answer = tuned(method_of(row), model);
        const char* table = model.L > 0.9 ? "table3" : "table2";
        EXPECT_NEAR(answer.controller.Kp / r[table][0].get<double>(), 1, 1e-6) << row;
        const double ratio = r[model.L > 0.9 ? "ratio_table3" : "ratio_table2"];
        EXPECT_NEAR(cost_of(row, *LinearPlant::make(model), answer.controller) / r["J"].get<double>() / ratio, 1, 1e-3)
            << row;
    }
}

}  // namespace
}  // namespace tunewright
