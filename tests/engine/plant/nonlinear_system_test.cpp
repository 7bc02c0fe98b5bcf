// A nonlinear plant's steady state and linearisation against independently computed values.
#include "engine/plant/nonlinear_system.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/plant/linear_plant.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

void expect_close(double actual, double expected, double relative) {
    EXPECT_NEAR(actual, expected, relative * std::abs(expected));
}

TEST(NonlinearSystem, CstrSteadyStateIsReachedFromThePrintedRoundedOne) {
    const auto system = made_system(cstr("T"));
    EXPECT_NEAR(system.x_steady()[0], 0.520329995811418, 1e-12);
    EXPECT_NEAR(system.x_steady()[1], 398.96799958114184, 1e-10);
    EXPECT_EQ(system.y_steady(), system.x_steady()[1]);
    EXPECT_EQ(system.order(), 2);
}

TEST(NonlinearSystem, CstrLinearisationIsExact) {
    const auto linear = made_system(cstr("CA")).linearised();
    expect_close(linear.A[0][0], -1.9218572983488496, 1e-11);
    expect_close(linear.A[0][1], -0.024107735705294824, 1e-11);
    expect_close(linear.A[1][0], -184.3714596697699, 1e-11);
    expect_close(linear.A[1][1], -6.821547141058964, 1e-11);
    EXPECT_EQ(linear.B, (std::vector<double>{0, 1}));
    EXPECT_EQ(linear.C, (std::vector<double>{1, 0}));
    const auto plant = LinearPlant::make(linear);
    ASSERT_TRUE(plant.has_value());
    expect_close(plant->low_frequency_gain(), -0.0027821128126172497, 1e-10);
}

TEST(NonlinearSystem, OtherParametersHaveTheirOwnSteadyState) {
    const auto nominal = made_system(cstr("T"));
    const auto other = nominal.with({{"UA", 1.1e5}});
    ASSERT_TRUE(other.has_value());
    std::vector<double> rates(2);
    ASSERT_TRUE(other->rates(other->x_steady(), 493.87, rates));
    EXPECT_NEAR(rates[0], 0, 1e-13);
    EXPECT_NEAR(rates[1], 0, 1e-10);
    EXPECT_GT(other->y_steady(), nominal.y_steady() + 1);
    const auto unknown = nominal.with({{"XY", 1}});
    ASSERT_FALSE(unknown.has_value());
    EXPECT_EQ(unknown.error().where, "XY");
}

TEST(NonlinearSystem, AnIntegratingTankKeepsTheLevelThatWasGiven) {
    NonlinearPlant tank{.states = {{"h", 0.7}},
                        .parameters = {{"A", 2.0}, {"q", 0.3}},
                        .equations = {{"h", "(qi - q)/A"}},
                        .input = {.name = "qi", .nominal = 0.3},
                        .output = "h"};
    EXPECT_DOUBLE_EQ(made_system(tank).x_steady()[0], 0.7);
    tank.input.nominal = 0.31;
    const auto drifting = NonlinearSystem::make(tank);
    ASSERT_FALSE(drifting.has_value());
    EXPECT_NE(drifting.error().message.find("dh/dt is still 0.005"), std::string::npos) << drifting.error().message;
}

TEST(NonlinearSystem, NoSteadyStateNearIsAnErrorThatSaysHowFarItGot) {
    for (const char* rate : {"1 + x^2 + u", "exp(x)", "x - 30"}) {
        const auto system = NonlinearSystem::make(scalar_plant(rate));
        ASSERT_FALSE(system.has_value()) << rate;
        EXPECT_EQ(system.error().where, "plant/states");
        EXPECT_NE(system.error().message.find("no steady state near"), std::string::npos) << system.error().message;
    }
}

}  // namespace
}  // namespace tunewright
