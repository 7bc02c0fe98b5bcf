// The method emulation: exact cases, independent optima, properties and defaults. The reactor of Mhaskar, El-Farra and
// Christofides is in tests/papers.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "engine/tuning/emulation/emulation_report.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/tuning/emulation_support.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

// Reference: an own RK4 and Nelder and Mead's simplex, 8000 steps.
TEST(Emulation, OptimaOnAConicalTankAreThoseOfAnIndependentSearch) {
    const EmulationPlant tank = emulation_plant(conical_tank());
    const double reference[][4] = {{0, 0.3922938482, 2.24659485, 0.0001044225336},
                                   {4, 0.4178010701, 2.53049458, 0.0005780054969}};
    for (const auto& [wy, Kp, Ti, J] : reference) {
        MethodOptions options = cone_step();
        options.set("weights/wy", wy);
        const auto answer = emulated(tank.problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_NEAR(answer->controller.Kp / Kp, 1, 2e-3);
        EXPECT_NEAR(answer->controller.Ti / Ti, 1, 2e-3);
        EXPECT_NEAR(answer->report_as<EmulationReport>()->J / J, 1, 3e-5);
    }
}

// Reference: as above, 4000 steps.
TEST(Emulation, OptimaOnAPendulumAreThoseOfAnIndependentSearch) {
    const EmulationPlant plant = emulation_plant(pendulum());
    struct Row {
        double wy;
        const char* derivative_on;
        double Kp, Ti, Td, J;
    };
    for (const Row& row : {Row{0, "measurement", 9.113873189, 1.631424402, 0.4607051596, 0.06029900302},
                           Row{50, "measurement", 9.117588372, 1.65694677, 0.4544093773, 0.06103167844},
                           Row{50, "error", 2.446016082, 0.5861803436, 0.32566262, 1.959776542}}) {
        MethodOptions options = pendulum_step(row.wy);
        options.set("derivative_on", std::string(row.derivative_on));
        const auto answer = emulated(plant.problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_NEAR(answer->controller.Kp / row.Kp, 1, 2e-3);
        EXPECT_NEAR(answer->controller.Ti / row.Ti, 1, 2e-3);
        EXPECT_NEAR(answer->controller.Td / row.Td, 1, 2e-3);
        EXPECT_NEAR(answer->report_as<EmulationReport>()->J / row.J, 1, 3e-5);
    }
}

// Direct synthesis: on K/(T s + 1) a first-order target of time gamma is the PI with Ti = T, Kp = T/(K gamma).
TEST(Emulation, OnAFirstOrderPlantThePiIsTheNonlinearController) {
    const Plant plant = Fopdt{.K = -2, .T = 5, .L = 0};
    const TuningProblem problem{plant, LinearPlant::make(plant).value(), std::nullopt, std::nullopt};
    for (const char* formulation : {"full", "remark6"}) {
        MethodOptions options = step_of(1, 10, "PI");
        options.set("formulation", std::string(formulation));
        options.set("target/gamma", 1.25);
        const auto answer = emulated(problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_NEAR(answer->controller.Kp, -2, 2e-6);
        EXPECT_NEAR(answer->controller.Ti, 5, 5e-6);
        EXPECT_LT(answer->report_as<EmulationReport>()->fit.u_left, 1e-10);
        EXPECT_TRUE(answer->report_as<EmulationReport>()->fit.adequate);
        EXPECT_EQ(answer->report_as<EmulationReport>()->relative_degree, 1);
    }
}

// On K/((T1 s + 1)(T2 s + 1)) a target tau^2 s^2 + 2 xi tau s + 1 is a PID with Tf = tau/(2 xi), derivative of the
// error: (T1 s + 1)(T2 s + 1)/(K 2 xi tau s (Tf s + 1)).
TEST(Emulation, OnASecondOrderPlantAFreeFilterFindsTheExactPid) {
    const Plant plant = Sopdt{.K = 2, .T1 = 4, .T2 = 1, .L = 0};
    const TuningProblem problem{plant, LinearPlant::make(plant).value(), std::nullopt, std::nullopt};
    const double tau = 0.8, xi = 1.2, Tf = tau / (2 * xi), Ki = 1 / (2 * 2 * xi * tau), Kp = Ki * (5 - Tf);
    for (const char* formulation : {"full", "remark6"}) {
        MethodOptions options = step_of(1, 8, "PID");
        options.set("formulation", std::string(formulation));
        options.set("target/tau_cl", tau);
        options.set("target/xi", xi);
        options.set("derivative_on", std::string("error"));
        set_range(options, "Tf", 0.05, 1);
        const auto answer = emulated(problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_NEAR(answer->controller.filter.Tf / Tf, 1, 1e-3);
        EXPECT_NEAR(answer->controller.Kp / Kp, 1, 1e-3);
        EXPECT_NEAR(answer->controller.Ti / (Kp / Ki), 1, 1e-3);
        EXPECT_NEAR(answer->controller.Td / ((Ki * 4 - Kp * Tf) / Kp), 1, 1e-3);
        EXPECT_EQ(answer->controller.c, 1);
        EXPECT_LT(answer->report_as<EmulationReport>()->fit.u_left, 1e-7);
    }
}

TEST(Emulation, NoSettingsOfTheFirstLevelInsideTheBoundsAreBetter) {
    const std::pair<NonlinearPlant, double> cases[] = {
        {cstr("T"), 10}, {cstr("CA"), 0.05}, {conical_tank(), 0.2}, {spherical_tank(0.25, 0.2), 0.05}};
    for (const auto& [plant, r] : cases) {
        SCOPED_TRACE(plant.output);
        for (const char* formulation : {"full", "remark6"}) {
            const EmulationPlant given = emulation_plant(plant);
            MethodOptions options;
            options.set("scenarios/0/setpoint_step", r);
            options.set("formulation", std::string(formulation));
            options.set("bounds_from/methods/0", std::string("imc"));
            options.set("bounds_from/methods/1", std::string("simc"));
            options.set("bounds_from/methods/2", std::string("ziegler_nichols_ultimate"));
            const auto answer = emulated(given.problem, options);
            ASSERT_TRUE(answer) << answer.error().message;
            const EmulationReport& report = *answer->report_as<EmulationReport>();
            int compared = 0;
            for (const LevelOneRow& row : report.level1) {
                EXPECT_NE(row.controller.has_value(), !row.error.empty()) << row.title;
                if (!row.controller || !row.J) continue;
                const IdealPid& pid = std::get<IdealPid>(*row.controller);
                const auto inside = [&](const char* name, double value) {
                    return value >= report.bounds.at(name).low && value <= report.bounds.at(name).high;
                };
                if (!inside("Kp", pid.Kp) || !inside("Ti", pid.Ti) || !inside("Td", pid.Td)) continue;
                ++compared;
                EXPECT_LE(report.J, *row.J * (1 + 1e-9)) << row.title;
            }
            EXPECT_GE(compared, 1);
        }
    }
}

TEST(Emulation, BoundsAreAlphaTimesTheFirstLevelsSettings) {
    const EmulationPlant given = emulation_plant(cstr("CA"));
    MethodOptions options = step_of(0.05, 2, "PID");
    options.set("formulation", std::string("remark6"));
    options.set("bounds_from/methods/0", std::string("imc"));
    set_range(options, "bounds_from/alpha", 0.5, 3);
    set_range(options, "bounds/Td", 0.01, 0.3);
    const auto answer = emulated(given.problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    double min = HUGE_VAL, max = 0;
    for (const LevelOneRow& row : answer->report_as<EmulationReport>()->level1) {
        ASSERT_TRUE(row.controller) << row.error;
        min = std::min(min, -std::get<IdealPid>(*row.controller).Kp);
        max = std::max(max, -std::get<IdealPid>(*row.controller).Kp);
    }
    const auto& bounds = answer->report_as<EmulationReport>()->bounds;
    EXPECT_DOUBLE_EQ(bounds.at("Kp").low, -3 * max);
    EXPECT_DOUBLE_EQ(bounds.at("Kp").high, -0.5 * min);
    EXPECT_DOUBLE_EQ(bounds.at("Td").low, 0.01);
    EXPECT_DOUBLE_EQ(bounds.at("Td").high, 0.3);
}

TEST(Emulation, ScalesWithTheUnitsOfTimeAndOutput) {
    for (const char* formulation : {"full", "remark6"}) {
        MethodOptions plain = cone_step(), scaled = cone_step(60, 100);
        plain.set("formulation", std::string(formulation));
        scaled.set("formulation", std::string(formulation));
        const auto a = emulated(emulation_plant(conical_tank()).problem, plain);
        const auto b = emulated(emulation_plant(conical_tank(60, 100)).problem, scaled);
        ASSERT_TRUE(a && b);
        EXPECT_NEAR(b->controller.Kp * 100 / a->controller.Kp, 1, 1e-5);
        EXPECT_NEAR(b->controller.Ti / 60 / a->controller.Ti, 1, 1e-5);
        EXPECT_NEAR(b->report_as<EmulationReport>()->J / 60 / a->report_as<EmulationReport>()->J, 1, 1e-5);
    }
}

TEST(Emulation, JIsTheMeanOverTheScenarios) {
    const EmulationPlant plant = emulation_plant(pendulum());
    const auto fixed = [&](const std::vector<double>& steps) {
        MethodOptions options = pendulum_step(20);
        set_range(options, "bounds/Kp", 9, 9 + 1e-9);
        set_range(options, "bounds/Ti", 1.5, 1.5 + 1e-9);
        set_range(options, "bounds/Td", 0.4, 0.4 + 1e-9);
        for (std::size_t i = 0; i < steps.size(); ++i)
            options.set("scenarios/" + std::to_string(i) + "/setpoint_step", steps[i]);
        const auto answer = emulated(plant.problem, options);
        EXPECT_TRUE(answer) << answer.error().message;
        return answer->report_as<EmulationReport>()->J;
    };
    const double first = fixed({0.8}), second = fixed({-0.5}), both = fixed({0.8, -0.5});
    EXPECT_NEAR(both / (0.5 * (first + second)), 1, 1e-7);
    EXPECT_NEAR(fixed({0.8, 0.8, 0.8}) / first, 1, 1e-7);
}

TEST(Emulation, AScenarioMayStartElsewhereOrHaveOtherParameters) {
    const EmulationPlant plant = emulation_plant(pendulum());
    MethodOptions options = pendulum_step(20);
    options.set("scenarios/1/setpoint_step", 0.0);
    options.set("scenarios/1/initial/angle", 0.6);
    options.set("scenarios/2/setpoint_step", 0.4);
    options.set("scenarios/2/parameters/a", 5.0);
    const auto answer = emulated(plant.problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    const auto& scenarios = answer->report_as<EmulationReport>()->scenarios;
    ASSERT_EQ(scenarios.size(), 3u);
    EXPECT_NEAR(scenarios[1].y.front(), 0.6, 1e-9);
    EXPECT_NEAR(scenarios[1].y_nl.back(), 0.3, 1e-3);
    const double rest = std::asin(1.1820808266453582 / 5);
    EXPECT_NEAR(scenarios[2].y_rest, rest, 1e-9);
    EXPECT_NEAR(scenarios[2].y_nl.back(), rest + 0.4, 1e-3);
    EXPECT_NEAR(scenarios[2].u_rest, 1.1820808266453582, 1e-12);
}

TEST(Emulation, ABoundThatHoldsTheOptimumIsTold) {
    MethodOptions options = cone_step();
    set_range(options, "bounds/Kp", 0.6, 5);
    for (const char* formulation : {"full", "remark6"}) {
        options.set("formulation", std::string(formulation));
        const auto answer = emulated(emulation_plant(conical_tank()).problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        ASSERT_EQ(answer->report_as<EmulationReport>()->active_bounds.size(), 1u);
        const ActiveBound& bound = answer->report_as<EmulationReport>()->active_bounds.front();
        EXPECT_EQ(bound.parameter, "Kp");
        EXPECT_FALSE(bound.high);
        EXPECT_EQ(bound.value, 0.6);
        EXPECT_EQ(answer->controller.Kp, 0.6);
        EXPECT_TRUE(has_warning(*answer, "at-bound"));
    }
}

TEST(Emulation, LimitsOfTheInputActInBothRuns) {
    NonlinearPlant limited = conical_tank();
    limited.input.min = 0.0;
    limited.input.max = 0.58;
    for (const char* formulation : {"full", "remark6"}) {
        MethodOptions options = cone_step();
        options.set("formulation", std::string(formulation));
        const auto free = emulated(emulation_plant(conical_tank()).problem, options);
        const auto answer = emulated(emulation_plant(limited).problem, options);
        ASSERT_TRUE(free && answer) << answer.error().message;
        const EmulatedScenario& scenario = answer->report_as<EmulationReport>()->scenarios.front();
        EXPECT_TRUE(scenario.limited);
        EXPECT_FALSE(free->report_as<EmulationReport>()->scenarios.front().limited);
        EXPECT_TRUE(has_warning(*answer, "nonlinear-controller-limited"));
        EXPECT_LE(*std::ranges::max_element(scenario.u_nl), 0.58 + 1e-12);
        EXPECT_LE(*std::ranges::max_element(scenario.u), 0.58 + 1e-12);
        EXPECT_LT(answer->report_as<EmulationReport>()->fit.u_left, 0.05);
    }
}

TEST(Emulation, WorksWithDeadTime) {
    NonlinearPlant plant = conical_tank();
    plant.L = 0.4;
    const auto answer = emulated(emulation_plant(plant).problem, cone_step());
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_TRUE(answer->report_as<EmulationReport>()->fit.adequate)
        << answer->report_as<EmulationReport>()->fit.sentence;
    const EmulatedScenario& scenario = answer->report_as<EmulationReport>()->scenarios.front();
    for (std::size_t i = 0; i < scenario.t.size() && scenario.t[i] <= 0.4; ++i)
        EXPECT_NEAR(scenario.y_nl[i], 1, 1e-9) << scenario.t[i];
}

TEST(Emulation, TakesPolesForHigherRelativeDegrees) {
    const Plant plant = Zpk{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0}, .L = 0};
    const TuningProblem problem{plant, LinearPlant::make(plant).value(), std::nullopt, std::nullopt};
    MethodOptions options = step_of(1, 8, "PID");
    options.set("target/poles/0", -1.5);
    options.set("target/poles/1/0", -1.2);
    options.set("target/poles/1/1", 0.5);
    options.set("target/poles/2/0", -1.2);
    options.set("target/poles/2/1", -0.5);
    const auto answer = emulated(problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_EQ(answer->report_as<EmulationReport>()->relative_degree, 3);
    ASSERT_EQ(answer->report_as<EmulationReport>()->beta.size(), 4u);
    EXPECT_NEAR(answer->report_as<EmulationReport>()->beta[3], 1 / (1.5 * (1.44 + 0.25)), 1e-12);
    EXPECT_TRUE(emulated(problem, step_of(1, 8, "PI")));
}

TEST(Emulation, DefaultsServeEveryPlant) {
    for (const NonlinearPlant& plant : {cstr("T"), cstr("CA"), spherical_tank(0.25, 0.2), conical_tank()}) {
        SCOPED_TRACE(plant.output);
        const auto answer = emulated(emulation_plant(plant).problem, {});
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_TRUE(has_warning(*answer, "default-scenario"));
        EXPECT_EQ(answer->report_as<EmulationReport>()->formulation, "full");
        EXPECT_TRUE(answer->report_as<EmulationReport>()->fit.adequate)
            << answer->report_as<EmulationReport>()->fit.sentence;
    }
}

TEST(Emulation, DefaultsServeAnUnstableOperatingPointAndAVerySteepPlant) {
    const NonlinearPlant washout = bioreactor(0.9951, 1.5122), neutral = ph_vessel(1e-6, (0.01 - 1e-6) / (0.01 + 1e-6));
    for (const NonlinearPlant& plant : {washout, neutral}) {
        SCOPED_TRACE(plant.output);
        const EmulationPlant given = emulation_plant(plant);
        MethodOptions options;
        options.set("controller", std::string("PI"));
        const auto answer = emulated(given.problem, options);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_TRUE(answer->report_as<EmulationReport>()->scenarios.front().ended.empty());
        EXPECT_LT(answer->report_as<EmulationReport>()->fit.u_left, 0.5);
    }
}

}  // namespace
}  // namespace tunewright
