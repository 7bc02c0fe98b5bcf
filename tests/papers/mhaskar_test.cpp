// Mhaskar, El-Farra and Christofides (2004): Tables II and III, the first level and the optima of the second level,
// compared with the printed figures and independently recomputed ones (tests/data/emulation). Step sizes and horizons
// are not printed anywhere: those used here are the recomputation's.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/tuning/emulation/emulation_report.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/tuning/emulation_support.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

const Json& mhaskar_reference() {
    static const Json json = Json::parse(std::ifstream(test_data("emulation/levels.json")));
    return json;
}

bool is_T(const std::string& name) { return name.find("_T_") != name.npos; }

const EmulationPlant& reactor(bool of_T) {
    static const EmulationPlant T = emulation_plant(cstr("T")), CA = emulation_plant(cstr("CA"));
    return of_T ? T : CA;
}

// gamma 0.25 of the T loop, tau_cl 0.2 and xi 1.05 of the CA loop; tau_f 0.1.
MethodOptions loop_options(bool of_T, double r, double tf) {
    MethodOptions options;
    options.set("controller", std::string(of_T ? "PI" : "PID"));
    if (of_T) {
        options.set("target/gamma", 0.25);
    } else {
        options.set("target/tau_cl", 0.2);
        options.set("target/xi", 1.05);
        options.set("Tf", 0.1);
    }
    options.set("scenarios/0/setpoint_step", r);
    options.set("horizon", tf);
    return options;
}

MethodOptions options_of(const Json& row) {
    const bool of_T = is_T(row["name"]);
    MethodOptions options = loop_options(of_T, row["r"], row["tf"]);
    options.set("formulation", std::string(row["approx"].get<bool>() ? "remark6" : "full"));
    options.set("derivative_on", std::string(row["kick"].get<bool>() ? "error" : "measurement"));
    if (!row["approx"].get<bool>()) options.set("weights/wy", row["wy"].get<double>());
    options.set("weights/wu", row["wu"].get<double>());
    const char* names[] = {"Kp", "Ti", "Td"};
    for (std::size_t i = 0; i < row["lo"].size(); ++i)
        set_range(options, std::string("bounds/") + names[i], row["lo"][i], row["hi"][i]);
    return options;
}

std::vector<double> settings(const IdealPid& pid) { return {pid.Kp, pid.Ti, pid.Td}; }

TEST(Mhaskar, OptimaOfTheSecondLevelAreTheRecomputedOnes) {
    for (const Json& row : mhaskar_reference()["level2"]) {
        SCOPED_TRACE(row["name"].get<std::string>() + " " + row["variant"].get<std::string>());
        const auto answer = emulated(reactor(is_T(row["name"])).problem, options_of(row));
        ASSERT_TRUE(answer) << answer.error().message;
        const double tolerance = row["approx"].get<bool>() ? 1e-4 : 2e-3;
        for (std::size_t i = 0; i < row["params"].size(); ++i)
            EXPECT_NEAR(settings(answer->controller)[i] / row["params"][i].get<double>(), 1, tolerance) << i;
        const EmulationReport& report = *answer->report_as<EmulationReport>();
        EXPECT_LE(report.J, row["J"].get<double>() * (1 + 3e-5));
        EXPECT_NEAR(report.J / row["J"].get<double>(), 1, row["tol_rel_J"].get<double>());
        EXPECT_NEAR(report.J_u / row["int_du2"].get<double>(), 1, 2e-3);
        if (!row["int_dy2"].is_null()) {
            EXPECT_NEAR(*report.J_y / row["int_dy2"].get<double>(), 1, 0.02);
        }
        std::size_t active = 0;
        for (const bool held : row["bound_active"]) active += held;
        EXPECT_EQ(report.active_bounds.size(), active);
    }
}

// For Remark 6 the recomputation's half-widths are exact; for the full problem they are those of Gauss and Newton,
// which neglect the curvature of y and u: there J itself is the reference.
TEST(Mhaskar, HowFlatTheOptimaAreIsTheRecomputedHessians) {
    const char* names[] = {"Kp", "Ti", "Td"};
    for (const Json& row : mhaskar_reference()["level2"]) {
        SCOPED_TRACE(row["name"].get<std::string>() + " " + row["variant"].get<std::string>());
        const auto answer = emulated(reactor(is_T(row["name"])).problem, options_of(row));
        ASSERT_TRUE(answer) << answer.error().message;
        const double tolerance = row["approx"].get<bool>() ? 2e-3 : 0.25;
        for (std::size_t i = 0; i < row["params"].size(); ++i) {
            EXPECT_NEAR(answer->report_as<EmulationReport>()->flatness_alone.at(names[i]) /
                            row["halfwidth_J_plus_5pct_others_fixed"][i].get<double>(),
                        1, tolerance);
            EXPECT_NEAR(answer->report_as<EmulationReport>()->flatness.at(names[i]) /
                            row["halfwidth_J_plus_5pct_others_reoptimised"][i].get<double>(),
                        1, tolerance);
        }
    }
}

TEST(Mhaskar, AParameterMovedByItsFlatnessAloneRaisesJByFivePercent) {
    const char* names[] = {"Kp", "Ti", "Td"};
    for (const Json& row : mhaskar_reference()["level2"]) {
        SCOPED_TRACE(row["name"].get<std::string>() + " " + row["variant"].get<std::string>());
        const TuningProblem& problem = reactor(is_T(row["name"])).problem;
        const auto answer = emulated(problem, options_of(row));
        ASSERT_TRUE(answer) << answer.error().message;
        if (!answer->report_as<EmulationReport>()->active_bounds.empty()) continue;
        const auto J_at = [&](std::vector<double> point) {
            MethodOptions options = options_of(row);
            for (std::size_t i = 0; i < row["params"].size(); ++i)
                set_range(options, std::string("bounds/") + names[i], point[i], point[i] + 1e-9 * std::abs(point[i]));
            return emulated(problem, options).value().report_as<EmulationReport>()->J;
        };
        for (std::size_t i = 0; i < row["params"].size(); ++i) {
            std::vector<double> up = settings(answer->controller), down = up;
            up[i] += answer->report_as<EmulationReport>()->flatness_alone.at(names[i]);
            down[i] -= answer->report_as<EmulationReport>()->flatness_alone.at(names[i]);
            EXPECT_NEAR(0.5 * (J_at(up) + J_at(down)) / answer->report_as<EmulationReport>()->J, 1.05, 2e-3);
        }
    }
}

TEST(Mhaskar, TableIIIsProposedRowIsReachedByRemark6AtALargePositiveStep) {
    MethodOptions options = loop_options(false, 0.1416, 1.17);
    options.set("formulation", std::string("remark6"));
    set_range(options, "bounds/Kp", -2000, -1000);
    set_range(options, "bounds/Ti", 0.1, 2);
    set_range(options, "bounds/Td", 0.02, 0.15);
    const auto answer = emulated(reactor(false).problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    const auto printed = mhaskar_reference()["published"]["table3"]["proposed"];
    EXPECT_NEAR(answer->controller.Kp / printed[0].get<double>(), 1, 1e-3);
    EXPECT_NEAR(answer->controller.Ti / printed[1].get<double>(), 1, 5e-3);
    EXPECT_NEAR(answer->controller.Td, printed[2].get<double>(), 5e-3);
}

// Table II prints Kc 5.38 with tau_I 2.1. The gain is reproduced; a tau_I near 2.1 is impossible: under Remark 6 the
// PI's final u is Kc gamma/tau_I per unit of r, at least the 2 (actually 4.51) K per K that any steady state needs, so
// tau_I is at most 0.67. The optimisation gives about 0.21 to 0.28.
TEST(Mhaskar, TableIIsProposedGainIsReachedItsIntegralTimeIsAMisprint) {
    for (const auto& [r, tf] : {std::pair{10.0, 2.0}, {5.0, 3.0}}) {
        MethodOptions options = loop_options(true, r, tf);
        options.set("formulation", std::string("remark6"));
        set_range(options, "bounds/Kp", 0.1, 15);
        set_range(options, "bounds/Ti", 0.05, 3);
        const auto answer = emulated(reactor(true).problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        const auto printed = mhaskar_reference()["published"]["table2"]["proposed"];
        EXPECT_NEAR(answer->controller.Kp / printed[0].get<double>(), 1, 1e-2);
        EXPECT_LT(answer->controller.Ti, 0.3);
        EXPECT_GT(answer->controller.Ti, 0.2);
        MethodOptions as_printed = options;
        as_printed.set("formulation", std::string("full"));
        as_printed.set("weights/wy", 0.0);
        set_range(as_printed, "bounds/Kp", 5.3799, 5.3801);
        set_range(as_printed, "bounds/Ti", 2.0999, 2.1001);
        const auto there = emulated(reactor(true).problem, as_printed);
        ASSERT_TRUE(there) << there.error().message;
        if (r == 10) {
            EXPECT_NEAR(there->report_as<EmulationReport>()->J_u /
                            mhaskar_reference()["table2_J_full_r10_tf2"]["printed 5.38/2.1"]["int_du2"].get<double>(),
                        1, 1e-3);
        }
        EXPECT_FALSE(there->report_as<EmulationReport>()->fit.adequate);
    }
}

TEST(Mhaskar, OptimaOfRemark6OverManyStepsAndHorizons) {
    for (const bool of_T : {true, false}) {
        const char* names[] = {"Kp", "Ti", "Td"};
        for (const Json& row : mhaskar_reference()["approx_sensitivity"][of_T ? "T" : "CA_no_kick"]) {
            SCOPED_TRACE(row.dump());
            MethodOptions options = loop_options(of_T, row[0], row[1]);
            options.set("formulation", std::string("remark6"));
            for (std::size_t i = 2; i < row.size(); ++i) {
                const double value = row[i], size = std::abs(value);
                set_range(options, std::string("bounds/") + names[i - 2], value - 0.9 * size, value + 5 * size);
            }
            const auto answer = emulated(reactor(of_T).problem, options);
            ASSERT_TRUE(answer) << answer.error().message;
            for (std::size_t i = 2; i < row.size(); ++i)
                EXPECT_NEAR(settings(answer->controller)[i - 2] / row[i].get<double>(), 1, 1e-4);
        }
    }
}

// Remark 1. Reference: an own RK4 and Nelder and Mead's simplex, 3200 steps.
TEST(Mhaskar, ThreeStepsAreAveraged) {
    MethodOptions options = loop_options(false, 0.05, 2);
    options.set("scenarios/1/setpoint_step", 0.1);
    options.set("scenarios/2/setpoint_step", -0.05);
    options.set("weights/wy", 1e8);
    set_range(options, "bounds/Kp", -2000, -500);
    set_range(options, "bounds/Ti", 0.1, 2);
    set_range(options, "bounds/Td", 0.02, 0.15);
    const auto answer = emulated(reactor(false).problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_NEAR(answer->controller.Kp / -1044.50371, 1, 1e-4);
    EXPECT_NEAR(answer->controller.Ti / 1.20320721, 1, 1e-4);
    EXPECT_NEAR(answer->controller.Td / 0.0982479678, 1, 1e-4);
    EXPECT_NEAR(answer->report_as<EmulationReport>()->J / 86.09413919, 1, 1e-6);
}

const LevelOneRow* row_of(const EmulationReport& report, const std::string& method, const std::string& test) {
    for (const LevelOneRow& row : report.level1)
        if (row.method == method && row.test == test) return &row;
    return nullptr;
}

// Printed: -1342.7, 0.95, 0.0524; the step of its test is not given.
TEST(Mhaskar, ImcOnTheDefaultStepTestIsTableIIIsFirstRow) {
    MethodOptions options = loop_options(false, 0.05, 2);
    options.set("formulation", std::string("remark6"));
    const auto answer = emulated(reactor(false).problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    const LevelOneRow* step = row_of(*answer->report_as<EmulationReport>(), "imc", "step");
    ASSERT_TRUE(step && step->controller) << (step ? step->error : "no row");
    const auto imc_I = settings(std::get<IdealPid>(*step->controller));
    EXPECT_NEAR(imc_I[0] / -1342.7, 1, 0.01);
    EXPECT_NEAR(imc_I[1] / 0.95, 1, 0.01);
    EXPECT_NEAR(imc_I[2] / 0.0524, 1, 0.02);
}

TEST(Mhaskar, TheFirstLevelsImcRowsAreTableIIIs) {
    MethodOptions options = loop_options(false, 0.05, 2);
    options.set("bounds_from/methods/0", std::string("imc"));
    options.set("bounds_from/lambda", 0.2);
    options.set("bounds_from/test_step", 5.0);
    options.set("formulation", std::string("remark6"));
    const auto answer = emulated(reactor(false).problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    const LevelOneRow* linear = row_of(*answer->report_as<EmulationReport>(), "imc", "linear");
    ASSERT_TRUE(linear && linear->controller) << (linear ? linear->error : "no row");
    const auto imc_II = settings(std::get<IdealPid>(*linear->controller));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(imc_II[i] / mhaskar_reference()["level1"]["IMC_II_lambda_0p2"][i].get<double>(), 1, 1e-6);
    const LevelOneRow* step = row_of(*answer->report_as<EmulationReport>(), "imc", "step");
    ASSERT_TRUE(step && step->controller) << (step ? step->error : "no row");
    const auto imc_I = settings(std::get<IdealPid>(*step->controller));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(imc_I[i] / mhaskar_reference()["level1"]["step_tests"][0]["CA_IMC_PID_lambda_0p2"][i].get<double>(),
                    1, 0.01);
}

}  // namespace
}  // namespace tunewright
