// A nonlinear plant's steady state and linearisation against independently computed values.
#include "engine/plant/nonlinear/nonlinear_system.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/plant/linear/linear_plant.h"
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

TEST(NonlinearSystem, SphericalTankAgreesWithItsFormulas) {
    for (const double start : {0.3, 0.5, 0.6}) {
        const auto system = made_system(spherical_tank(start, 0.28));
        const double h = std::pow(0.28 / 0.4, 2), area = std::acos(-1.0) * h * (1 - h);
        EXPECT_NEAR(system.x_steady()[0], h, 1e-15) << start;
        expect_close(system.linearised().A[0][0], -0.4 / (2 * std::sqrt(h)) / area, 1e-13);
        expect_close(system.linearised().B[0], 1 / area, 1e-13);
    }
}

TEST(NonlinearSystem, BioreactorKeepsToTheNearestOfItsThreeSteadyStates) {
    // mu(S) = D is a quadratic in S; X = Y (Sf - S).
    const double a = 0.3 * 0.4545, b = 0.3 - 0.53, c = 0.3 * 0.12, root = std::sqrt(b * b - 4 * a * c);
    const double low = (-b - root) / (2 * a), high = (-b + root) / (2 * a);
    for (const auto& [X, S] : {std::pair{1.5, 0.18}, std::pair{1.6, 0.12}}) {
        const auto system = made_system(bioreactor(X, S));
        expect_close(system.x_steady()[0], 0.4 * (4 - low), 1e-14);
        expect_close(system.x_steady()[1], low, 1e-13);
    }
    const auto unstable = made_system(bioreactor(0.995, 1.51));
    expect_close(unstable.x_steady()[1], high, 1e-13);
    EXPECT_EQ(LinearPlant::make(unstable.linearised())->unstable_poles(), 1);
    const auto washout = made_system(bioreactor(0, 4));
    EXPECT_EQ(washout.x_steady()[0], 0);
    EXPECT_DOUBLE_EQ(washout.x_steady()[1], 4);
}

TEST(NonlinearSystem, PhVesselIsSolvedThroughItsSteepestPoint) {
    const auto neutral = made_system(ph_vessel(0, 1));
    EXPECT_NEAR(neutral.y_steady(), 7, 1e-12);
    EXPECT_NEAR(neutral.linearised().C[0], -1 / (2e-7 * std::log(10)), 1e-3);
    const auto acid = made_system(ph_vessel(1e-4, 0.98));
    const double left = 0.01 * 0.02 / 1.98;
    expect_close(acid.x_steady()[0], left, 1e-12);
    EXPECT_NEAR(acid.y_steady(), -std::log10(left), 1e-6);
}

TEST(NonlinearSystem, AnUprightPendulumStandsAtItsZeros) {
    const NonlinearPlant plant{.states = {{"angle", 0}, {"rate", 0}},
                               .parameters = {{"g", 9.81}, {"l", 0.5}},
                               .equations = {{"angle", "rate"}, {"rate", "g/l*sin(angle) - u*cos(angle)/l"}},
                               .input = {.name = "u", .nominal = 0},
                               .output = "angle"};
    const auto system = made_system(plant);
    EXPECT_EQ(system.x_steady()[0], 0);
    EXPECT_DOUBLE_EQ(system.linearised().A[1][0], 9.81 / 0.5);
    EXPECT_DOUBLE_EQ(system.linearised().B[1], -2);
    EXPECT_EQ(LinearPlant::make(system.linearised())->unstable_poles(), 1);
}

// Its speed is 0 there: a state without a natural size.
TEST(NonlinearSystem, AHangingPendulumRestsWhereItsTorqueHoldsIt) {
    for (const double drag : {0.0, 0.2}) {
        const NonlinearPlant plant{
            .states = {{"angle", 0.5}, {"rate", 0}},
            .parameters = {{"g", 9.81}, {"a", drag}},
            .equations = {{"angle", "rate"}, {"rate", "u - g*sin(angle) - a*rate - 0.3*rate*abs(rate)"}},
            .input = {.name = "u", .nominal = 4.703},
            .output = "angle"};
        const auto system = made_system(plant);
        EXPECT_NEAR(system.x_steady()[0], std::asin(4.703 / 9.81), 1e-12) << drag;
        EXPECT_NEAR(system.x_steady()[1], 0, 1e-12) << drag;
    }
}

TEST(NonlinearSystem, RoughStatesReachTheSameSteadyState) {
    const double reference = made_system(cstr("T")).y_steady();
    for (const double CA : {0.4, 0.52, 0.7})
        for (const double T : {380.0, 398.97, 420.0}) {
            auto plant = cstr("T");
            plant.states = {{"CA", CA}, {"T", T}};
            EXPECT_NEAR(made_system(plant).y_steady(), reference, 1e-9) << CA << " " << T;
        }
}

TEST(NonlinearSystem, ParametersMayBeExpressionsInAnyOrder) {
    auto plant = cstr("T");
    plant.parameters[0].value = "F*residence";
    plant.parameters[5].value = "heat*10";
    plant.parameters.push_back({"heat", "2*10^4"});
    plant.parameters.push_back({"residence", 1.0});
    const auto system = made_system(plant);
    EXPECT_DOUBLE_EQ(system.y_steady(), made_system(cstr("T")).y_steady());
    const auto larger = system.with({{"heat", 21000}});
    ASSERT_TRUE(larger.has_value());
    EXPECT_DOUBLE_EQ(larger->y_steady(), made_system(cstr("T")).with({{"DH", 2.1e5}})->y_steady());
}

TEST(NonlinearSystem, LeavingTheDomainIsSaidAndNamed) {
    const auto tank = made_system(spherical_tank(0.49, 0.28));
    std::vector<double> dx(1);
    EXPECT_TRUE(tank.rates(std::vector{0.2}, 0.3, dx));
    EXPECT_EQ(tank.domain_fault(std::vector{0.2}, 0.3), "");
    EXPECT_FALSE(tank.rates(std::vector{-0.2}, 0.3, dx));
    EXPECT_EQ(tank.domain_fault(std::vector{-0.2}, 0.3), "Equation h, character 8: sqrt of -0.2 does not exist.");
    EXPECT_FALSE(tank.rates(std::vector{0.0}, 0.3, dx));
    EXPECT_EQ(tank.domain_fault(std::vector{0.0}, 0.3), "Equation h, character 16: division by zero.");
}

TEST(NonlinearSystem, JacobianIsExactBeyondThreeDirections) {
    // A chain of eight states with known derivatives: x_i' = x_(i-1)^2 - x_i^3, x_0 = u.
    NonlinearPlant chain{
        .states = {}, .parameters = {}, .equations = {}, .input = {.name = "u", .nominal = 1}, .output = "x8^2*x3"};
    for (int i = 1; i <= 8; ++i) {
        const std::string name = "x" + std::to_string(i), before = i == 1 ? "u" : "x" + std::to_string(i - 1);
        chain.states.push_back({name, 1.05});
        chain.equations.push_back({name, before + "^2 - " + name + "^3"});
    }
    const auto linear = made_system(chain).linearised();
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t j = 0; j < 8; ++j)
            EXPECT_NEAR(linear.A[i][j], i == j ? -3 : j + 1 == i ? 2 : 0, 1e-13) << i << " " << j;
        EXPECT_NEAR(linear.B[i], i == 0 ? 2 : 0, 1e-13);
        EXPECT_NEAR(linear.C[i], i == 7 ? 2 : i == 2 ? 1 : 0, 1e-13);
    }
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
