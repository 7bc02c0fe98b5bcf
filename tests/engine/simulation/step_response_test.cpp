// The exact open-loop step response compared with closed formulas.
#include "engine/simulation/linear/step_response.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tunewright {
namespace {

LinearPlant made(const Plant& plant) { return *LinearPlant::make(plant); }

TEST(StepResponse, EightEqualLagsFollowTheErlangDistribution) {
    const auto plant = made(Zpk{.K = 1, .zeros = {}, .poles = std::vector<std::complex<double>>(8, -1.0)});
    const auto samples = step_response(plant);
    EXPECT_LT(samples.size(), 2000u);
    for (const auto& s : samples) {
        double term = std::exp(-s.t), sum = 0;
        for (int k = 0; k < 8; ++k, term *= s.t / k) sum += term;
        EXPECT_NEAR(s.y, 1 - sum, 1e-12) << "t " << s.t;
        EXPECT_NEAR(s.slope, std::exp(-s.t) * std::pow(s.t, 7) / 5040, 1e-12) << "t " << s.t;
    }
    EXPECT_NEAR(samples.back().y, 1, 1e-6);
}

TEST(StepResponse, LagsThatLieAMillionApartAreBothResolved) {
    const auto plant = made(Sopdt{.K = 2, .T1 = 1000, .T2 = 1e-3});
    const auto samples = step_response(plant);
    EXPECT_LT(samples.size(), 2000u);
    bool in_the_fast_part = false;
    for (const auto& s : samples) {
        const double y = 2 * (1 - (1000 * std::exp(-s.t / 1000) - 1e-3 * std::exp(-s.t / 1e-3)) / (1000 - 1e-3));
        EXPECT_NEAR(s.y, y, 1e-9) << "t " << s.t;
        in_the_fast_part = in_the_fast_part || (s.t > 1e-4 && s.t < 1e-3);
    }
    EXPECT_TRUE(in_the_fast_part);
    EXPECT_GT(samples.back().t, 14'000);
}

TEST(StepResponse, OscillationIsSampledFinerThanATenthRadianUntilItHasDied) {
    const double zeta = 0.05;
    const auto plant = made(OscillatorySopdt{.K = 1, .T = 2, .zeta = zeta});
    const auto samples = step_response(plant);
    const double root = std::sqrt(1 - zeta * zeta);
    for (size_t i = 1; i < samples.size(); ++i) {
        const double x = samples[i].t / 2;
        const double y = 1 - std::exp(-zeta * x) * (std::cos(root * x) + zeta / root * std::sin(root * x));
        EXPECT_NEAR(samples[i].y, y, 1e-10);
        if (zeta * x < 14) {
            EXPECT_LE(samples[i].t - samples[i - 1].t, 0.2 + 1e-12);
        }
    }
}

TEST(StepResponse, AnyInstantInBetweenIsExact) {
    const auto plant = made(Zpk{.K = 3, .zeros = {0.5}, .poles = {-1.0, -2.0}, .L = 4});
    const auto samples = step_response(plant);
    const auto s = step_response_after(plant.realisation(), samples[3], 0.731);
    const double t = samples[3].t + 0.731;
    // 3 (s - 0.5)/((s + 1)(s + 2)) / s: residues -0.75, 4.5, -3.75.
    EXPECT_NEAR(s.y, -0.75 + 4.5 * std::exp(-t) - 3.75 * std::exp(-2 * t), 1e-13);
    EXPECT_NEAR(s.slope, -4.5 * std::exp(-t) + 7.5 * std::exp(-2 * t), 1e-12);
    EXPECT_NEAR(s.curvature, 4.5 * std::exp(-t) - 15 * std::exp(-2 * t), 1e-12);
    EXPECT_DOUBLE_EQ(s.t, t);
}

TEST(StepResponse, DirectTermJumpsAtOnce) {
    const auto samples = step_response(made(TransferFunction{.num = {2, 1}, .den = {4, 1}}));
    EXPECT_DOUBLE_EQ(samples.front().y, 0.5);
}

}  // namespace
}  // namespace tunewright
