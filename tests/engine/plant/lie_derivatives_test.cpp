// Relative degrees and Lie derivatives against formulas derived by hand.
#include "engine/plant/nonlinear/lie_derivatives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

TEST(LieDerivatives, CstrHasRelativeDegreeOneForTAndTwoForCA) {
    EXPECT_EQ(*relative_degree(made_system(cstr("T"))), 1);
    EXPECT_EQ(*relative_degree(made_system(cstr("CA"))), 2);
}

TEST(LieDerivatives, ReducedCstrFormulas) {
    const double CA = 0.61, T = 405.5;
    const double k = 4.71e8 * std::exp(-8000 / T), dk = k * 8000 / (T * T);
    const double f1 = (1 - CA) - k * CA, f2 = (400 - T) - 200 * k * CA - T;  // Tj's coefficient is 1
    LieDerivatives lie;
    ASSERT_TRUE(lie_derivatives(made_system(cstr("T")), 1, std::vector{CA, T}, lie));
    EXPECT_DOUBLE_EQ(lie.of_f[0], T);
    EXPECT_NEAR(lie.of_f[1], f2, 1e-12 * 800);
    EXPECT_DOUBLE_EQ(lie.of_g, 1);
    ASSERT_TRUE(lie_derivatives(made_system(cstr("CA")), 2, std::vector{CA, T}, lie));
    EXPECT_NEAR(lie.of_f[1], f1, 1e-14);
    EXPECT_NEAR(lie.of_f[2], (-1 - k) * f1 - dk * CA * f2, 1e-12);
    EXPECT_NEAR(lie.of_g, -dk * CA, 1e-15);
}

TEST(LieDerivatives, BioreactorAndTankFormulas) {
    LieDerivatives lie;
    const double X = 1.4, S = 0.21, mu = 0.53 * S / (0.12 + S + 0.4545 * S * S);
    ASSERT_TRUE(lie_derivatives(made_system(bioreactor(1.53, 0.175)), 1, std::vector{X, S}, lie));
    EXPECT_NEAR(lie.of_f[1], mu * X, 1e-15);
    EXPECT_NEAR(lie.of_g, -X, 1e-15);
    const double h = 0.6, area = std::acos(-1.0) * h * (1 - h);
    ASSERT_TRUE(lie_derivatives(made_system(spherical_tank(0.49, 0.28)), 1, std::vector{h}, lie));
    EXPECT_NEAR(lie.of_f[1], -0.4 * std::sqrt(h) / area, 1e-15);
    EXPECT_NEAR(lie.of_g, 1 / area, 1e-15);
}

TEST(LieDerivatives, AChainIsExactToTheFourthOrder) {
    NonlinearPlant plant{.states = {{"x1", 1}, {"x2", 0}, {"x3", 0}, {"x4", 0}},
                         .parameters = {},
                         .equations = {{"x1", "x2"}, {"x2", "x3"}, {"x3", "x4^2"}, {"x4", "x1*u"}},
                         .input = {.name = "u", .nominal = 0},
                         .output = "x1"};
    const auto system = made_system(plant);
    LieDerivatives lie;
    ASSERT_TRUE(lie_derivatives(system, 4, std::vector{0.5, 0.6, 0.7, 0.8}, lie));
    EXPECT_DOUBLE_EQ(lie.of_f[3], 0.64);
    EXPECT_DOUBLE_EQ(lie.of_f[4], 0);
    EXPECT_DOUBLE_EQ(lie.of_g, 2 * 0.8 * 0.5);  // 2 x4 x1: 0 at the operating point, where x4 = 0
    EXPECT_FALSE(relative_degree(system).has_value());
}

TEST(RelativeDegree, ACancellationThatHoldsEverywhereIsNoEffect) {
    // u moves both states alike and the output is their difference: it enters one derivative later.
    NonlinearPlant plant{.states = {{"a", 0.3}, {"b", 0.6}},
                         .parameters = {},
                         .equations = {{"a", "-a + (1 + a*b)*u/3"}, {"b", "-0.5*b + u*a*b/3 + u/3"}},
                         .input = {.name = "u", .nominal = 1},
                         .output = "a - b"};
    plant.states = {{"a", 0.44}, {"b", 0.88}};
    EXPECT_EQ(*relative_degree(made_system(plant)), 2);
    plant.output = "a - 1.001*b";
    EXPECT_EQ(*relative_degree(made_system(plant)), 1);
}

TEST(RelativeDegree, NearTheSingularPointItIsStillDefined) {
    for (const double x : {1e-3, 1e-2}) {
        NonlinearPlant plant = scalar_plant("-x + x0 + sin(x)*u", x);
        plant.parameters = {{"x0", x}};
        EXPECT_EQ(*relative_degree(made_system(plant)), 1) << x;
    }
}

TEST(RelativeDegree, ChainsHaveTheirLength) {
    for (int n = 1; n <= 8; ++n) {
        NonlinearPlant chain{.states = {},
                             .parameters = {},
                             .equations = {},
                             .input = {.name = "u", .nominal = 1},
                             .output = "x" + std::to_string(n)};
        for (int i = 1; i <= n; ++i) {
            const std::string name = "x" + std::to_string(i),
                              before = i == 1 ? "u" : "x" + std::to_string(i - 1) + "^2";
            chain.states.push_back({name, 1});
            chain.equations.push_back({name, before + " - " + name + "^3"});
        }
        EXPECT_EQ(*relative_degree(made_system(chain)), n);
        EXPECT_TRUE(zero_dynamics(made_system(chain)).zeros.empty());
    }
}

TEST(ZeroDynamics, CstrAndBioreactor) {
    const auto T = zero_dynamics(made_system(cstr("T")));
    ASSERT_EQ(T.zeros.size(), 1U);
    EXPECT_NEAR(T.zeros[0].real(), -1.9218572983488496, 1e-8);
    EXPECT_TRUE(T.stable);
    EXPECT_TRUE(zero_dynamics(made_system(cstr("CA"))).zeros.empty());
    // 1/(s+1) - 1.5/(s+2)
    NonlinearPlant inverse{.states = {{"x1", 1}, {"x2", -0.75}},
                           .parameters = {},
                           .equations = {{"x1", "-x1 + u"}, {"x2", "-2*x2 - 1.5*u"}},
                           .input = {.name = "u", .nominal = 1},
                           .output = "x1 + x2"};
    const auto zeros = zero_dynamics(made_system(inverse));
    ASSERT_EQ(zeros.zeros.size(), 1U);
    EXPECT_NEAR(zeros.zeros[0].real(), 1, 1e-12);  // (s+2) - 1.5 (s+1) = 0.5 - 0.5 s
    EXPECT_FALSE(zeros.stable);
}

TEST(ZeroDynamics, VanDeVussesReactorIsUnstableLeftOfItsMaximum) {
    // Doyle, Ogunnaike & Pearson (1995): A -> B -> C, 2A -> D; CA = 3.0, CB = 1.12 for F/V = 34.3 1/h.
    const NonlinearPlant plant{.states = {{"CA", 3.0}, {"CB", 1.12}},
                               .parameters = {{"k1", 50.0}, {"k2", 100.0}, {"k3", 10.0}, {"CAf", 10.0}},
                               .equations = {{"CA", "-k1*CA - k3*CA^2 + u*(CAf - CA)"}, {"CB", "k1*CA - k2*CB - u*CB"}},
                               .input = {.name = "u", .nominal = 34.3},
                               .output = "CB"};
    const auto system = made_system(plant);
    const double CA = (-84.3 + std::sqrt(84.3 * 84.3 + 40 * 343)) / 20, CB = 50 * CA / 134.3;
    EXPECT_NEAR(system.x_steady()[0], CA, 1e-13);
    EXPECT_NEAR(system.y_steady(), CB, 1e-13);
    EXPECT_EQ(*relative_degree(system), 1);
    const auto zeros = zero_dynamics(system);
    ASSERT_EQ(zeros.zeros.size(), 1U);
    EXPECT_NEAR(zeros.zeros[0].real(), -(50 + 20 * CA + 34.3) + 50 * (10 - CA) / CB, 1e-9);
    EXPECT_FALSE(zeros.stable);
}

}  // namespace
}  // namespace tunewright
