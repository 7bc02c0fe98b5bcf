// Averaging level control against its closed forms.
#include "engine/structure/level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace tunewright::structure {
namespace {

TEST(Level, TheFrontierIsThatOfTheClosedForms) {
    struct Row {
        double zeta, Kc, Ti, rate;
    };
    // Volume, step and room 1.
    for (const Row& row : {Row{0.3, 0.4029282355972665, 0.8934593513069806, 0.5462385161},
                           {0.4, 0.48234550987054386, 1.3268497102248737, 0.5206377699},
                           {0.5, 0.5462930158736015, 1.8305194665556095, 0.5462930159},
                           {std::numbers::sqrt2 / 2, 0.6447938838896689, 3.1017663938360522, 0.6447938838896689},
                           {1.0, 2 / std::numbers::e, 2 * std::numbers::e, 2 / std::numbers::e},
                           {1.5, 0.824799844983378, 10.911738229268671, 0.824799845},
                           {2.0, 0.8742423691917034, 18.30156094447023, 0.8742423692}}) {
        const auto level = design_level({.aim = LevelAim::zeta, .zeta = row.zeta});
        ASSERT_TRUE(level);
        EXPECT_NEAR(level->design.Kc, row.Kc, 1e-6 * row.Kc) << row.zeta;
        EXPECT_NEAR(level->design.Ti, row.Ti, 1e-6 * row.Ti) << row.zeta;
        EXPECT_NEAR(level->design.largest_rate, row.rate, 1e-6 * row.rate) << row.zeta;
        EXPECT_NEAR(level->design.highest, 1, 1e-12) << row.zeta;
    }
}

/// The vessel over time, by Runge and Kutta's rule: largest level and rate of the outflow.
std::pair<double, double> simulated(const LevelDesign& d, const LevelProblem& p) {
    double h = 0, integral = 0, highest = 0, rate = 0;
    const double dt = 1e-4 * p.allowed * p.area / p.step;
    for (int i = 0; i < 200000; ++i) {
        const auto slope = [&](double level, double sum) { return (p.step - d.Kc * (level + sum / d.Ti)) / p.area; };
        const double k1 = slope(h, integral), k2 = slope(h + 0.5 * dt * k1, integral + 0.5 * dt * h),
                     k3 = slope(h + 0.5 * dt * k2, integral + 0.5 * dt * (h + 0.5 * dt * k1)),
                     k4 = slope(h + dt * k3, integral + dt * (h + 0.5 * dt * k2));
        rate = std::max(rate, std::abs(d.Kc * (k1 + h / d.Ti)));
        integral += dt * (h + dt * (k1 + k2 + k3) / 6);
        h += dt * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
        highest = std::max(highest, h);
    }
    return {highest, rate};
}

TEST(Level, TheVesselDoesWhatTheClosedFormsSay) {
    const LevelProblem problem{.area = 12, .step = 4, .allowed = 1.8};
    const auto level = design_level(problem);
    ASSERT_TRUE(level);
    EXPECT_DOUBLE_EQ(level->bound, 4 * 4 / (2 * 12 * 1.8));
    const auto [highest, rate] = simulated(level->design, problem);
    EXPECT_NEAR(highest, 1.8, 1e-6);
    EXPECT_NEAR(rate, level->design.largest_rate, 1e-6 * rate);
}

TEST(Level, ProportionalActionAloneUsesTheRoomOutsideTheGap) {
    const auto level = design_level({.area = 2, .step = 3, .allowed = 5, .aim = LevelAim::no_overshoot, .gap = 1});
    ASSERT_TRUE(level);
    EXPECT_DOUBLE_EQ(level->design.Kc, 3.0 / 4);
    EXPECT_TRUE(std::isinf(level->design.Ti));
    EXPECT_DOUBLE_EQ(level->design.highest, 5);
    EXPECT_EQ(level->design.overshoot_percent, 0);
}

TEST(Level, TheFlowLoopGivesThePeaksOfPublishedSettings) {
    // process-control-toolbox, article 6: 0.02 e^(-10s)/s, Ms 1.70, 1.17, 1.14, 1.09.
    struct Row {
        LevelSettings settings;
        double Ms;
    };
    for (const Row& row : {Row{{2.5, 80}, 1.70352169},
                           {{0.83, 240}, 1.17103527},
                           {{0.75, {}}, 1.14262485},
                           {{0.46, 1000}, 1.08781953}}) {
        const auto level = design_level({.area = 50, .flow = FlowLoop{.T = 0, .L = 10}, .given = row.settings});
        ASSERT_TRUE(level && level->Ms);
        EXPECT_NEAR(*level->Ms, row.Ms, 2e-5 * row.Ms);
    }
}

TEST(Level, SmutsRuleIsTheDampingOne) {
    // Kc = 0.74 df/dL, Ti = 4 tres/Kc: 20 % of flow, 30 % of level, 10 of residence.
    const auto level = design_level(
        {.area = 10, .step = 20, .allowed = 30, .given = LevelSettings{0.74 * 20 / 30, 4 * 10 / (0.74 * 20 / 30)}});
    ASSERT_TRUE(level);
    EXPECT_NEAR(level->design.zeta, 1, 1e-9);
    EXPECT_NEAR(level->design.highest, 29.828062798, 1e-4);
    EXPECT_NEAR(level->design.overshoot_percent, 100 * std::exp(-2.0), 1e-4);
}

TEST(Level, NumbersOutOfRangeAreRefused) {
    const auto place = [](const LevelProblem& problem) {
        const auto level = design_level(problem);
        return level ? std::string("none") : level.error().where;
    };
    EXPECT_EQ(place({.area = 0}), "volume");
    EXPECT_EQ(place({.step = -1}), "largest_step");
    EXPECT_EQ(place({.allowed = 0}), "allowed");
    EXPECT_EQ(place({.aim = LevelAim::zeta, .zeta = 0}), "zeta");
    EXPECT_EQ(place({.aim = LevelAim::no_overshoot, .gap = 1}), "gap");
    EXPECT_EQ(place({.gap = 0.5}), "gap");
    EXPECT_EQ(place({.flow = FlowLoop{.T = -1}}), "flow_loop");
}

}  // namespace
}  // namespace tunewright::structure
