// A loop at many frequencies compared with the same loop at one, and its parts: the unit circle by polynomials and the
// winding angle of a curve.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/loop/loop.h"
#include "engine/loop/winding.h"
#include "engine/numerics/pair_complex.h"

namespace tunewright {
namespace {

TEST(PairComplex, UnitCircleIsSineAndCosineOfTheLibrary) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> digits(-6, 6), sign(-1, 1);
    const auto near = [](double angle) {
        const PairComplex z = unit_circle(Pair{angle, -angle});
        for (const std::size_t i : {0u, 1u}) {
            const double exact = i == 0 ? angle : -angle;
            EXPECT_NEAR(z.re[i], std::cos(exact), 2.3e-16) << exact;
            EXPECT_NEAR(z.im[i], std::sin(exact), 2.3e-16) << exact;
        }
    };
    for (int i = 0; i < 100'000; ++i) near(std::copysign(std::pow(10, digits(random)), sign(random)));
    // Near the multiples of pi/4, where polynomials and quarters change.
    for (int k = -50; k <= 50; ++k)
        for (const double off : {-1e-9, -1e-16, 0.0, 1e-16, 1e-9}) near(k * std::numbers::pi / 4 * (1 + off));
    near(kMaxPairAngle);
}

TEST(Loop, AtManyFrequenciesIsThatAtEachAndSoIsItsPlant) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
    for (int trial = 0; trial < 200; ++trial) {
        Zpk description{.K = log_uniform(0.1, 10), .zeros = {}, .poles = {}};
        description.L = trial % 3 == 0 ? 0 : log_uniform(0.01, 30);
        for (int i = 0; i < trial % 5; ++i) description.poles.emplace_back(i == 3 ? 0 : -log_uniform(0.01, 5));
        if (trial % 5 == 4) {
            description.zeros.emplace_back(log_uniform(0.3, 5));
            const std::complex<double> mode(-0.01, log_uniform(0.1, 3));
            description.poles.insert(description.poles.end(), {mode, std::conj(mode)});
        }
        const auto plant = LinearPlant::make(description);
        ASSERT_TRUE(plant);
        ParallelPid gains{.Kp = log_uniform(0.02, 5), .Kd = log_uniform(0.01, 2)};
        if (trial % 2 == 0) gains.Ki = log_uniform(0.01, 5);
        gains.filter.type = std::array{FilterType::derivative, FilterType::measurement_first_order,
                                       FilterType::measurement_second_order, FilterType::none}[trial % 4];
        gains.filter.Tf = gains.filter.type == FilterType::none ? 0 : log_uniform(0.01, 1);
        const auto loop = Loop::make(*plant, gains);
        if (!loop) continue;
        // An odd number of frequencies, some beyond the range of the vectorised code: 0, angles of e^(-jwL) and squares
        // out of range.
        std::vector<double> omega{0, 1e-200, 1e-120};
        for (int i = 0; i < 60; ++i) omega.push_back(log_uniform(1e-6, 1e6));
        omega.insert(omega.end(), {1e9, 1e100, 1e150, 0.5});
        const auto points = loop->at(omega);
        const auto responses = plant->at(omega);
        ASSERT_EQ(points.size(), omega.size());
        ASSERT_EQ(responses.size(), omega.size());
        const auto expect_same = [&](std::complex<double> many, std::complex<double> one, double w) {
            if (!std::isfinite(std::abs(one))) return;
            EXPECT_LE(std::abs(many - one), 1e-12 * std::abs(one)) << "trial " << trial << " at " << w;
        };
        for (std::size_t i = 0; i < omega.size(); ++i) {
            const LoopPoint one = loop->at(omega[i]);
            expect_same(points[i].L, one.L, omega[i]);
            expect_same(points[i].S, one.S, omega[i]);
            expect_same(points[i].T, one.T, omega[i]);
            expect_same(points[i].CS, one.CS, omega[i]);
            expect_same(responses[i], plant->at(std::complex<double>(0, omega[i])), omega[i]);
        }
    }
}

TEST(Winding, AddsUpWhatASpiralTurnsThrough) {
    for (const double turns : {0.3, 1.0, 7.25, -4.5}) {
        const auto spiral = [&](double t) {
            return std::polar(std::exp(3 * t), 0.7 + 2 * std::numbers::pi * turns * t);
        };
        Winding winding(spiral(0));
        const int steps = 400;
        for (int i = 1; i <= steps; ++i) {
            const double t = double(i) / steps;
            ASSERT_TRUE(Winding::is_short(spiral(t - 1.0 / steps), spiral(t)));
            // Sometimes by a known angle.
            if (i % 37 == 0)
                winding.turn(2 * std::numbers::pi * turns / steps, spiral(t));
            else
                winding.follow(spiral(t));
            EXPECT_NEAR(winding.angle(), 2 * std::numbers::pi * turns * t, 1e-12);
        }
    }
    EXPECT_FALSE(Winding::is_short({1, 0}, {0.5, 0.4}));
    EXPECT_FALSE(Winding::is_short({1, 0}, {0, 0}));
}

}  // namespace
}  // namespace tunewright
