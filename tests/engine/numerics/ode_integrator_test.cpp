#include "engine/numerics/ode_integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

OdeSystem oscillator() {
    return {2, [](double, std::span<const double> x, std::span<double> dx) {
                dx[0] = x[1];
                dx[1] = -x[0];
                return true;
            }};
}

OdeSystem robertson() {
    return {3, [](double, std::span<const double> x, std::span<double> dx) {
                dx[0] = -0.04 * x[0] + 1e4 * x[1] * x[2];
                dx[2] = 3e7 * x[1] * x[1];
                dx[1] = -dx[0] - dx[2];
                return true;
            }};
}

TEST(OdeIntegrator, FollowsAnOscillationBetweenItsStepsToo) {
    OdeIntegrator run(oscillator(), 1e-9);
    std::vector<double> x = {1, 0};
    ASSERT_TRUE(run.start(0, x));
    int steps = 0;
    while (run.t() < 20) {
        ASSERT_EQ(run.step(20), OdeStep::made);
        ++steps;
        for (const double s : {0.25, 0.5, 0.75, 1.0}) {
            const double t = run.t_before() + s * (run.t() - run.t_before());
            run.at(t, x);
            ASSERT_NEAR(x[0], std::cos(t), 2e-8) << t;
            ASSERT_NEAR(x[1], -std::sin(t), 2e-8) << t;
        }
    }
    EXPECT_EQ(run.t(), 20);
    EXPECT_LT(steps, 500);
    EXPECT_FALSE(run.stiff());
}

// Robertson (1966). y(40): the classical Runge-Kutta method with steps of 2e-5 in extended precision.
TEST(OdeIntegrator, TakesRobertsonsStiffReactionInFewSteps) {
    OdeIntegrator run(robertson(), 1e-8);
    ASSERT_TRUE(run.start(0, std::vector<double>{1, 0, 0}));
    int steps = 0;
    for (; run.t() < 40; ++steps) ASSERT_EQ(run.step(40), OdeStep::made);
    EXPECT_NEAR(run.x()[0], 0.7158270688, 1e-8);
    EXPECT_NEAR(run.x()[1], 9.185534765e-6, 1e-12);
    EXPECT_NEAR(run.x()[2], 0.2841637457, 1e-8);
    EXPECT_TRUE(run.stiff());
    EXPECT_LT(steps, 1000);
}

// x' = -1 - sqrt(x) reaches 0 at t = 2 (1 - ln 2) and does not exist beyond.
TEST(OdeIntegrator, EndsWhereTheRightHandSideDoes) {
    OdeSystem system{1, [](double, std::span<const double> x, std::span<double> dx) {
                         if (!(x[0] > 0)) return false;
                         dx[0] = -1 - std::sqrt(x[0]);
                         return true;
                     }};
    OdeIntegrator run(system, 1e-8);
    ASSERT_TRUE(run.start(0, std::vector<double>{1}));
    OdeStep last = OdeStep::made;
    while (last == OdeStep::made && run.t() < 10) last = run.step(10);
    EXPECT_EQ(last, OdeStep::left_domain);
    EXPECT_NEAR(run.t(), 2 * (1 - std::log(2.0)), 1e-7);
    EXPECT_GE(run.x()[0], 0);
}

TEST(OdeIntegrator, GoesBackToACrossingExactly) {
    OdeIntegrator run(oscillator(), 1e-10);
    std::vector<double> x = {1, 0};
    ASSERT_TRUE(run.start(0, x));
    while (run.x()[0] > 0) ASSERT_EQ(run.step(10), OdeStep::made);
    const auto zero = first_crossing(
        [&](double t) {
            run.at(t, x);
            return -x[0];
        },
        run.t_before(), run.t());
    ASSERT_TRUE(zero.has_value());
    EXPECT_NEAR(*zero, 2 * std::atan(1.0), 1e-9);
    ASSERT_EQ(run.shorten(*zero), OdeStep::made);
    EXPECT_EQ(run.t(), *zero);
    EXPECT_NEAR(run.x()[1], -1, 1e-9);
}

TEST(OdeIntegrator, StandsAtTheLastStepsBeginningWhereAShorterOneFails) {
    bool exists = true;
    OdeSystem system{1, [&](double, std::span<const double> x, std::span<double> dx) {
                         dx[0] = x[0];
                         return exists;
                     }};
    OdeIntegrator run(system, 1e-8);
    ASSERT_TRUE(run.start(0, std::vector<double>{1}));
    ASSERT_EQ(run.step(1), OdeStep::made);
    exists = false;
    EXPECT_EQ(run.shorten(0.5 * run.t()), OdeStep::left_domain);
    EXPECT_EQ(run.t(), 0);
    EXPECT_EQ(run.x()[0], 1);
}

}  // namespace
}  // namespace tunewright
