// Peaks, margins and stability of loops with closed-form results, and a comparison of the two stability methods.
#include "engine/loop/loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"

namespace tunewright {
namespace {

constexpr double kPi = std::numbers::pi;

LinearPlant made(const Plant& plant) {
    auto result = LinearPlant::make(plant);
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return *result;
}

Loop looped(const LinearPlant& plant, const ParallelPid& gains) {
    auto result = Loop::make(plant, gains);
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return *result;
}

TEST(Stability, IntegralControlOfPureDeadTimeIsStableUpToHalfPi) {
    // L(s) = Ki e^(-s)/s loses stability at Ki = pi/2.
    const auto plant = made(Fopdt{.K = 1, .T = 0, .L = 1});
    for (const double factor : {0.01, 0.5, 0.999, 0.999999})
        EXPECT_TRUE(count_unstable_poles(looped(plant, {.Ki = factor * kPi / 2})).stable()) << factor;
    for (const double factor : {1.000001, 1.001, 2.0})
        EXPECT_EQ(count_unstable_poles(looped(plant, {.Ki = factor * kPi / 2})).unstable_poles, 2) << factor;
    // The next pair crosses at Ki = 5 pi/2, then 9 pi/2.
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Ki = 5.1 * kPi / 2})).unstable_poles, 4);
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Ki = 9.1 * kPi / 2})).unstable_poles, 6);
}

TEST(Stability, UnstableFopdtNeedsEnoughAndNotTooMuchGain) {
    // e^(-0.2 s)/(s - 1) as K = -1, T = -1: with P control stable for 1 < |K Kp| < upper.
    const auto plant = made(Fopdt{.K = -1, .T = -1, .L = 0.2});
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Kp = 0.9})).unstable_poles, 1);
    EXPECT_TRUE(count_unstable_poles(looped(plant, {.Kp = 2})).stable());
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Kp = 20})).unstable_poles, 2);
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Kp = -2})).unstable_poles, 1);
}

TEST(Stability, DoubleIntegratorIsConditionallyStable) {
    const auto plant = made(TransferFunction{.num = {1}, .den = {1, 0, 0}, .L = 0});
    EXPECT_TRUE(count_unstable_poles(looped(plant, {.Kp = 1, .Ki = 0.1, .Kd = 1})).stable());
    EXPECT_FALSE(count_unstable_poles(looped(plant, {.Kp = 0.05, .Ki = 0.1, .Kd = 1})).stable());
    EXPECT_FALSE(count_unstable_poles(looped(plant, {.Kp = 1})).stable());
}

TEST(Stability, UndampedPlantNeedsNoIndentation) {
    const auto plant = made(OscillatorySopdt{.K = 1, .T = 1, .zeta = 0, .L = 0});
    EXPECT_TRUE(count_unstable_poles(looped(plant, {.Kp = 1, .Ki = 0.2, .Kd = 1})).stable());
    EXPECT_FALSE(count_unstable_poles(looped(plant, {.Kp = 1, .Ki = 0.2})).stable());
}

TEST(Stability, NeutralLoopWithGainAboveOneHasInfinitelyManyUnstablePoles) {
    const auto plant = made(Fopdt{.K = 1, .T = 1, .L = 1});
    EXPECT_EQ(count_unstable_poles(looped(plant, {.Kp = 0.1, .Ki = 0.1, .Kd = 1.2})).unstable_poles, -1);
    EXPECT_TRUE(count_unstable_poles(looped(plant, {.Kp = 0.4, .Ki = 0.3, .Kd = 0.2})).stable());
}

TEST(Stability, ZeroAtOriginUnderIntegralActionIsOnTheBoundary) {
    const auto plant = made(TransferFunction{.num = {1, 0}, .den = {1, 2, 1}, .L = 0});
    EXPECT_FALSE(count_unstable_poles(looped(plant, {.Kp = 1, .Ki = 1})).stable());
    EXPECT_TRUE(count_unstable_poles(looped(plant, {.Kp = 1})).stable());
}

TEST(Stability, TwoMethodsAgreeOnRandomLoopsOnBothSidesOfTheBoundary) {
    std::mt19937 random(20240517);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
    int stable = 0, unstable = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Zpk description{
            .K = log_uniform(0.1, 10), .zeros = {}, .poles = {}, .L = trial % 4 == 0 ? 0 : log_uniform(0.01, 2)};
        const int order = 1 + trial % 4;
        for (int i = 0; i < order; ++i)
            description.poles.emplace_back(unit(random) < 0.1    ? log_uniform(0.1, 1)
                                           : unit(random) < 0.15 ? 0
                                                                 : -log_uniform(0.1, 5));
        if (order > 2 && unit(random) < 0.5)
            description.zeros.emplace_back((unit(random) < 0.3 ? 1 : -1) * log_uniform(0.3, 5));
        if (!description.zeros.empty() && description.zeros[0].real() > 0) description.K = -description.K;
        const auto plant = made(description);
        const auto loop = looped(plant, {.Kp = log_uniform(0.02, 5),
                                         .Ki = log_uniform(0.002, 1),
                                         .Kd = log_uniform(0.01, 2),
                                         .filter = {FilterType::measurement_second_order, log_uniform(0.02, 0.5)}});
        const auto pole = rightmost_pole(loop, 32);
        ASSERT_TRUE(pole.has_value());
        const auto count = count_unstable_poles(loop);
        if (std::abs(pole->real()) < 1e-4) continue;
        EXPECT_EQ(count.stable(), pole->real() < 0)
            << "trial " << trial << " pole " << pole->real() << " count " << count.unstable_poles;
        (count.stable() ? stable : unstable)++;
    }
    EXPECT_GT(stable, 60);
    EXPECT_GT(unstable, 60);
}

TEST(Peaks, IntegralControlOfDeadTimeMeetsItsClosedForm) {
    // L = k e^(-jw)/(jw): |1 + L|^2 = 1 - 2 (k/w) sin w + (k/w)^2.
    const auto plant = made(Fopdt{.K = 1, .T = 0, .L = 1});
    const auto loop = looped(plant, {.Ki = 0.5});
    double best = 0;
    for (int i = 1; i < 2000000; ++i) {
        const double w = i * 5e-6, x = 0.5 / w;
        best = std::max(best, 1 / std::sqrt(1 - 2 * x * std::sin(w) + x * x));
    }
    const auto peaks = find_peaks(loop, make_peak_grid(loop));
    EXPECT_NEAR(peaks.S.value, best, 1e-9);
    EXPECT_NEAR(peaks.T.value, 1, 1e-9);
}

TEST(Peaks, NarrowResonanceIsFound) {
    // P control Kp of 1/(s^2 + 2 zeta s + 1): |S| = |D|/|D + Kp| with a peak of 1/(2 zeta) sharpness near sqrt(1 + Kp).
    const double zeta = 1e-3, Kp = 0.05;
    const auto plant = made(OscillatorySopdt{.K = 1, .T = 1, .zeta = zeta, .L = 0});
    const auto loop = looped(plant, {.Kp = Kp});
    double best = 0;
    for (int i = 0; i < 4000000; ++i) {
        const std::complex<double> s(0, 1.0 + i * 2e-8), D = s * s + 2 * zeta * s + 1.0;
        best = std::max(best, std::abs(D / (D + Kp)));
    }
    EXPECT_NEAR(find_peaks(loop, make_peak_grid(loop)).S.value / best, 1, 1e-8);
}

TEST(Peaks, NeutralLoopTakesItsLimitAnalytically) {
    const auto plant = made(Fopdt{.K = 1, .T = 1, .L = 1});
    const double q = 0.6;
    const auto loop = looped(plant, {.Kp = 0.05, .Ki = 0.05, .Kd = q});
    EXPECT_GE(find_peaks(loop, make_peak_grid(loop)).S.value, 1 / (1 - q) - 1e-12);
}

TEST(Peaks, PiOnMatchedLagHasNoPeakAboveOne) {
    // PI with Ti = T on 1/(s + 1): L = Kp/s, S = s/(s + Kp).
    const auto plant = made(Fopdt{.K = 1, .T = 1, .L = 0});
    const auto peaks = find_peaks(looped(plant, {.Kp = 3, .Ki = 3}), make_peak_grid(looped(plant, {.Kp = 3, .Ki = 3})));
    EXPECT_NEAR(peaks.S.value, 1, 1e-12);
    EXPECT_NEAR(peaks.T.value, 1, 1e-12);
    EXPECT_NEAR(peaks.CS.value, 3, 1e-9);
}

TEST(Margins, ThirdOrderLagHasItsTextbookGainMargin) {
    // 1/(s + 1)^3 with P control: Ku = 8 at omega = sqrt 3.
    const auto plant = made(TransferFunction{.num = {1}, .den = {1, 3, 3, 1}, .L = 0});
    const auto loop = looped(plant, {.Kp = 2});
    const auto margins = find_margins(loop, make_peak_grid(loop));
    EXPECT_NEAR(margins.gain_margin, 4, 1e-9);
    EXPECT_NEAR(margins.phase_crossover, std::sqrt(3.0), 1e-8);
    EXPECT_EQ(margins.gain_margin_low, 0);
    // |L| = 1 where (1 + w^2)^(3/2) = 2.
    const double w = std::sqrt(std::pow(2.0, 2.0 / 3) - 1);
    EXPECT_NEAR(margins.gain_crossover, w, 1e-9);
    EXPECT_NEAR(margins.phase_margin, kPi - 3 * std::atan(w), 1e-9);
    EXPECT_NEAR(margins.delay_margin, (kPi - 3 * std::atan(w)) / w, 1e-9);
}

TEST(Margins, BothSidesOfAConditionallyStableLoop) {
    const auto plant = made(Fopdt{.K = -1, .T = -1, .L = 0.2});
    const auto loop = looped(plant, {.Kp = 2});
    const auto margins = find_margins(loop, make_peak_grid(loop));
    EXPECT_NEAR(margins.gain_margin_low, 0.5, 1e-9);
    const auto edge = [&](double factor) { return count_unstable_poles(looped(plant, {.Kp = 2 * factor})).stable(); };
    EXPECT_TRUE(edge(margins.gain_margin * (1 - 1e-6)));
    EXPECT_FALSE(edge(margins.gain_margin * (1 + 1e-6)));
}

TEST(Margins, DelayMarginIsWhereStabilityEnds) {
    const auto plant = made(Sopdt{.K = 2, .T1 = 5, .T2 = 1, .L = 0.3});
    const ParallelPid gains{.Kp = 2, .Ki = 0.4, .Kd = 1, .filter = {FilterType::derivative, 0.1}};
    const auto loop = looped(plant, gains);
    const double delay = find_margins(loop, make_peak_grid(loop)).delay_margin;
    const auto stable_with = [&](double extra) {
        const auto slower = made(Sopdt{.K = 2, .T1 = 5, .T2 = 1, .L = 0.3 + extra});
        return count_unstable_poles(looped(slower, gains)).stable();
    };
    EXPECT_TRUE(stable_with(delay * (1 - 1e-5)));
    EXPECT_FALSE(stable_with(delay * (1 + 1e-5)));
}

TEST(Margins, NoDelayMarginWhereTheLoopGainStaysAboveOne) {
    const auto plant = made(TransferFunction{.num = {1, 1}, .den = {1, 2}, .L = 0});
    const auto loop = looped(plant, {.Kp = 3});
    EXPECT_EQ(find_margins(loop, make_peak_grid(loop)).delay_margin, 0);
}

TEST(Loop, RefusesWhatCannotBeALoop) {
    const auto direct = made(Fopdt{.K = 1, .T = 0, .L = 1});
    EXPECT_FALSE(Loop::make(direct, {.Kp = 1, .Kd = 1}).has_value());
    const auto plant = made(Fopdt{.K = 1, .T = 1, .L = 1});
    EXPECT_FALSE(Loop::make(plant, {}).has_value());
    const auto refused = Loop::make(plant, {.Kp = 1, .Kd = 1, .c = 1});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().where, "controller/c");
}

}  // namespace
}  // namespace tunewright
