// Parts of a search that replace exact computations: the sweep's loops in every kind of register, the gains that
// circles exclude, and the stability that the grid implies.
#include "engine/tuning/robust/sweep/sweep.h"

#include <gtest/gtest.h>

#include <complex>
#include <vector>

#include "engine/loop/peaks.h"
#include "engine/tuning/robust/sqp.h"
#include "engine/tuning/robust/sweep/encirclements.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright::robust {
namespace {

using test::Random;
using test::random_plant;
using Complex = std::complex<double>;

/// Frequencies and values of P without any plant behind them, from far below 1 to far above.
struct RandomGrid {
    std::vector<double> omega, re, im;

    RandomGrid(std::uint64_t seed, std::size_t n) {
        Random random(seed);
        double w = 1e-3;
        for (std::size_t i = 0; i < n; ++i) {
            omega.push_back(w *= random.log_uniform(1.01, 1.1));
            const Complex P = std::polar(random.log_uniform(1e-4, 1e3), random.uniform(-3.2, 3.2));
            re.push_back(P.real());
            im.push_back(P.imag());
        }
    }
    CurveGrid view() const { return {omega, re, im}; }
};

LoopGains random_gains(Random& random) {
    return {random.log_uniform(0.01, 100), random.log_uniform(0.01, 100), random.log_uniform(0.01, 100),
            random.log_uniform(1e-3, 1)};
}

Complex controller(const LoopGains& c, double w) {
    const Complex s(0, w);
    return (c.Kp + c.Ki / s + c.Kd * s) / (1.0 + c.Tf * s + 0.5 * c.Tf * c.Tf * s * s);
}

TEST(SweepLoops, EveryKindOfRegisterGivesTheSameDigits) {
    if (widest_registers() == Registers::common) GTEST_SKIP() << "this processor has no AVX2: run it on one that has";
    for (const std::size_t n : {0, 1, 3, 4, 7, 64, 1001}) {
        const RandomGrid grid(n + 1, n);
        Random random(n + 77);
        const LoopGains gains = random_gains(random), other = random_gains(random);
        const Circle a{-1, 0.7}, b{-2.1, 1.4};
        std::vector<std::vector<double>> values[2];
        bool less[2][2];
        for (const auto registers : {Registers::common, Registers::avx2}) {
            auto& v = values[registers == Registers::avx2];
            v.assign(14, std::vector<double>(n));
            peak_levels(grid.view(), gains, {0.5, 0.4, 0.1}, v[0].data(), v[1].data(), v[2].data(), registers);
            circle_levels(grid.view(), gains, b, v[3].data(), registers);
            open_loops(grid.view(), gains, Phase::as_it_is, v[4].data(), v[5].data(), registers);
            forbidden_factors(v[4], v[5], a, b, {v[6], v[7]}, {v[8], v[9]}, registers);
            turning_levels(grid.view(), gains, {0.5, 0.4, 0.1}, v[10].data(), v[11].data(), v[12].data(), registers);
            turning_levels(grid.view(), gains, {0.5, 0.4, 0.1}, v[10].data(), v[13].data(), nullptr, registers);
            for (const auto phase : {Phase::as_it_is, Phase::worst})
                less[registers == Registers::avx2][phase == Phase::worst] =
                    moves_less(grid.view(), gains, other, 1e3, phase, registers);
        }
        EXPECT_EQ(values[0], values[1]) << n;
        EXPECT_EQ(less[0][0], less[1][0]);
        EXPECT_EQ(less[0][1], less[1][1]);
    }
}

TEST(SweepLoops, LevelsAreThoseOfComplexArithmetic) {
    const RandomGrid grid(5, 200);
    Random random(6);
    const LoopGains gains = random_gains(random);
    std::vector<double> S(200), T(200), CS(200), circle(200);
    peak_levels(grid.view(), gains, {0.25, 0.5, 2}, S.data(), T.data(), CS.data());
    circle_levels(grid.view(), gains, {-1.5, 0.9}, circle.data());
    for (std::size_t i = 0; i < 200; ++i) {
        const Complex C = controller(gains, grid.omega[i]), L = C * Complex(grid.re[i], grid.im[i]);
        EXPECT_NEAR(S[i] / (0.25 / std::norm(1.0 + L)), 1, 1e-10);
        EXPECT_NEAR(T[i] / (0.5 * std::norm(L / (1.0 + L))), 1, 1e-10);
        EXPECT_NEAR(CS[i] / (2 * std::norm(C / (1.0 + L))), 1, 1e-10);
        EXPECT_NEAR(circle[i] / (0.81 / std::norm(L + 1.5)), 1, 1e-10);
    }
}

// At the worst phase L is -|L|; beyond |L| = 1, where every turn encircles -1, the level is far above any limit.
TEST(SweepLoops, LevelsWhereTheDeadTimeTurnsAreThoseOfTheWorstPhase) {
    const RandomGrid grid(11, 300);
    Random random(12);
    const LoopGains gains{.Kp = 0.2, .Ki = 0.1, .Kd = 0.05, .Tf = 0.3};
    std::vector<double> S(300), T(300), CS(300), S_alone(300), T_alone(300);
    turning_levels(grid.view(), gains, {0.25, 0.5, 2}, S.data(), T.data(), CS.data());
    turning_levels(grid.view(), gains, {0.25, 0.5, 0}, S_alone.data(), T_alone.data(), nullptr);
    EXPECT_EQ(S, S_alone);
    EXPECT_EQ(T, T_alone);
    int below = 0, above = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        const double C = std::abs(controller(gains, grid.omega[i])), L = C * std::abs(Complex(grid.re[i], grid.im[i]));
        if (L > 0.999) {
            EXPECT_GT(S[i], 1e4);
            ++above;
            continue;
        }
        EXPECT_NEAR(S[i] / (0.25 / ((1 - L) * (1 - L))), 1, 1e-9);
        EXPECT_NEAR(T[i] / (0.5 * L * L / ((1 - L) * (1 - L))), 1, 1e-9);
        EXPECT_NEAR(CS[i] / (2 * C * C / ((1 - L) * (1 - L))), 1, 1e-9);
        ++below;
    }
    EXPECT_GT(below, 50);
    EXPECT_GT(above, 20);
}

// Many rounded numbers are equal, also at the ends and across the borders of vectorised blocks.
TEST(SweepLoops, TopsAreNoLowerThanBeforeAndHigherThanAfter) {
    Random random(13);
    int found = 0;
    for (std::size_t n = 0; n < 90; ++n) {
        std::vector<double> level(n);
        for (double& x : level) x = std::floor(random.uniform(0, 6));
        std::vector<std::size_t> plain, common, widest;
        for (std::size_t i = 0; i < n; ++i)
            if (level[i] >= 3 && (i == 0 || level[i] >= level[i - 1]) && (i + 1 == n || level[i] > level[i + 1]))
                plain.push_back(i);
        local_maxima(level, 3, common, Registers::common);
        local_maxima(level, 3, widest);
        EXPECT_EQ(common, plain) << n;
        EXPECT_EQ(widest, plain) << n;
        found += static_cast<int>(plain.size());
    }
    EXPECT_GT(found, 500);
}

TEST(SweepLoops, AFactorIsForbiddenWhereItPutsTheLoopIntoACircle) {
    const RandomGrid grid(9, 400);
    const Circle a{-1, 1 / 1.6}, b{-1.6 * 1.6 / (1.6 * 1.6 - 1), 1.6 / (1.6 * 1.6 - 1)};
    std::vector<double> lower(400), upper(400), other_lower(400), other_upper(400);
    forbidden_factors(grid.re, grid.im, a, b, {lower, upper}, {other_lower, other_upper});
    Random random(10);
    int inside = 0;
    for (std::size_t i = 0; i < 400; ++i)
        for (int tries = 0; tries < 50; ++tries) {
            const Complex P(grid.re[i], grid.im[i]);
            const double k = random.log_uniform(0.05, 20) / std::abs(P);
            const bool in_circle = std::abs(k * P - a.centre) < a.radius || std::abs(k * P - b.centre) < b.radius;
            const bool told = (upper[i] > 0 && k > lower[i] && k < upper[i]) ||
                              (other_upper[i] > 0 && k > other_lower[i] && k < other_upper[i]);
            EXPECT_EQ(told, in_circle) << i << ' ' << k;
            inside += in_circle;
        }
    EXPECT_GT(inside, 500);
}

TEST(SweepLoops, MovesLessIsRouchesConditionOnTheGrid) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const RandomGrid grid(seed + 100, 60);
        Random random(seed);
        const LoopGains from = random_gains(random);
        LoopGains to = from;
        to.Kp *= random.uniform(0.9, 1.1);
        double largest = 0, worst = 0;
        for (std::size_t i = 0; i < 60; ++i) {
            const Complex P(grid.re[i], grid.im[i]), before = controller(from, grid.omega[i]);
            const double change = std::abs(P * (controller(to, grid.omega[i]) - before));
            largest = std::max(largest, change / std::abs(1.0 + P * before));
            const double nearest = 1 - std::abs(P * before);
            worst = nearest > 0 ? std::max(worst, change / nearest) : INFINITY;
        }
        for (const double slack : {0.999, 1.001}) {
            EXPECT_EQ(moves_less(grid.view(), from, to, largest * slack, Phase::as_it_is), slack > 1);
            const bool reached = !std::isfinite(worst);
            const double max = reached ? 1e9 : worst * slack;
            EXPECT_EQ(moves_less(grid.view(), from, to, max, Phase::worst), !reached && slack > 1);
        }
    }
}

DesignProblem problem_on(const LinearPlant& plant, double M, double sign = 1) {
    DesignProblem problem;
    problem.plant = &plant;
    problem.sign = sign;
    problem.limits.Ms = problem.limits.Mt = M;
    problem.filter.Tf_over_Td = 0.1;
    return problem;
}

// The exact count of unstable poles is the reference for the grid's statement on each gap.
TEST(Sweep, WhatTheGridTellsOfStabilityIsTrue) {
    int told = 0, stable = 0, finite = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const auto drawn = random_plant(seed, seed % 3 == 0);
        const auto plant = LinearPlant::make(drawn.plant);
        ASSERT_TRUE(plant);
        const DesignProblem problem = problem_on(*plant, drawn.M, seed % 5 == 0 ? -1 : 1);
        const Sweep sweep(problem, reference_frequency(problem));
        Random random(seed);
        for (int tries = 0; tries < 12; ++tries) {
            const double Ti = random.log_uniform(0.05, 60) / sweep.reference(),
                         Td = random.log_uniform(0.02, 8) / sweep.reference();
            for (const GainGap& gap : sweep.gain_gaps(Ti, Td)) {
                if (!std::isfinite(gap.upper) || gap.upper < gap.lower * (1 + 1e-6)) continue;
                ++finite;
                if (!gap.stable) continue;
                ++told;
                const bool counted = is_stable(problem, {std::log(gap.middle()), std::log(Ti), std::log(Td)});
                EXPECT_EQ(*gap.stable, counted) << drawn.description << ", Ti " << Ti << ", Td " << Td << ", gap from "
                                                << gap.lower << " to " << gap.upper;
                stable += counted;
            }
        }
    }
    EXPECT_GT(told, 0.8 * finite);
    EXPECT_GT(stable, 0.1 * told);
    EXPECT_GT(told - stable, 0.1 * told);
}

// Evaluated on the loop's own grid, which extends as far down as the loop needs: peaks between the sweep's grid points
// count too.
TEST(Sweep, GainsInsideAGapHoldTheLimits) {
    int judged = 0, integrating = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const auto drawn = random_plant(seed, false);
        const auto plant = LinearPlant::make(drawn.plant);
        const DesignProblem problem = problem_on(*plant, drawn.M);
        const Sweep sweep(problem, reference_frequency(problem));
        Random random(seed + 2000);
        for (int tries = 0; tries < 6; ++tries) {
            const double Ti = random.log_uniform(0.05, 60) / sweep.reference(),
                         Td = random.log_uniform(0.02, 8) / sweep.reference();
            for (const GainGap& gap : sweep.gain_gaps(Ti, Td)) {
                if (!std::isfinite(gap.upper) || gap.upper < gap.lower * (1 + 1e-3)) continue;
                const DesignPoint x = {std::log(gap.middle()), std::log(Ti), std::log(Td)};
                if (!is_stable(problem, x)) continue;
                const auto loop = Loop::make(*plant, to_parallel(controller_at(problem, x)));
                const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
                EXPECT_LE(std::max(peaks.S.value, peaks.T.value), drawn.M * (1 + 1e-3))
                    << drawn.description << ", Ti " << Ti << ", Td " << Td << ", gap from " << gap.lower << " to "
                    << gap.upper;
                ++judged;
                integrating += plant->integrators() > 0;
            }
        }
    }
    EXPECT_GT(judged, 300);
    EXPECT_GT(integrating, 30);
}

TEST(Sweep, WhatStaysStableIsStable) {
    int stayed = 0, tried = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const auto drawn = random_plant(seed, seed % 3 == 0);
        const auto plant = LinearPlant::make(drawn.plant);
        const DesignProblem problem = problem_on(*plant, drawn.M);
        const Sweep sweep(problem, reference_frequency(problem));
        Random random(seed + 1000);
        for (int tries = 0; tries < 20; ++tries) {
            const DesignPoint from = {random.uniform(-3, 3), std::log(random.log_uniform(0.1, 30) / sweep.reference()),
                                      std::log(random.log_uniform(0.02, 5) / sweep.reference())};
            if (!is_stable(problem, from)) continue;
            DesignPoint to = from;
            for (double& x : to) x += random.uniform(-0.5, 0.5);
            ++tried;
            if (!sweep.stays_stable(from, to)) continue;
            ++stayed;
            EXPECT_TRUE(is_stable(problem, to)) << drawn.description;
        }
    }
    EXPECT_GT(stayed, 0.2 * tried);
    EXPECT_GT(tried, 500);
}

TEST(AxisCrossings, SayNothingWhereNeighboursLieHalfATurnApart) {
    const std::vector<double> re = {1, -2, -0.1}, im = {-1, 1, 0.1};
    const AxisCrossings crossings(re, im);
    EXPECT_EQ(crossings.beyond(0.1), 0);
    EXPECT_FALSE(crossings.beyond(1).has_value());
}

TEST(PhaseFromRest, IsThatOfThePlantPlusWholeTurns) {
    const auto plant = LinearPlant::make(Zpk{
        .K = 3, .zeros = {0.5, {-0.1, 2}, {-0.1, -2}}, .poles = {-1.0, {-0.02, 1}, {-0.02, -1}, -3.0, 0.0}, .L = 2});
    ASSERT_TRUE(plant);
    const double start = std::arg(plant->at({0, 1e-6}));
    double followed = *phase_from_rest(*plant, 1e-6), before = start;
    for (double w = 1e-6; w < 20; w *= 1.002) {
        const double now = std::arg(plant->at({0, w}));
        followed += std::remainder(now - before, 2 * std::numbers::pi);
        before = now;
        EXPECT_NEAR(*phase_from_rest(*plant, w), followed, 1e-6) << w;
    }
    const auto unstable = LinearPlant::make(Zpk{.K = 1, .zeros = {}, .poles = {1.0}, .L = 0});
    EXPECT_NEAR(*phase_from_rest(*unstable, 1), 0.25 * std::numbers::pi, 1e-12);
    const auto undamped = LinearPlant::make(Zpk{.K = 1, .zeros = {}, .poles = {{0, 1}, {0, -1}}, .L = 0});
    EXPECT_FALSE(phase_from_rest(*undamped, 1).has_value());
}

}  // namespace
}  // namespace tunewright::robust
