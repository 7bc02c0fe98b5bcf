// Gain margins of loops whose dead time turns L hundreds of times before the critical crossing, compared with a dense
// scan along the axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/loop/margins.h"
#include "engine/loop/sampled/sampled_loop.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kMaxIntegral = 1;  // rad: pi/2 is the stability limit

/// 1/|L| at the crossing of the negative real axis where |L| is largest, between two frequencies.
double walked(const std::function<Complex(double)>& L, double from, double to, double delay) {
    constexpr double kLook = 0.02;  // rad of the dead time
    double largest = 0;
    Complex before = L(from);
    for (double a = from; a < to; a += kLook / delay) {
        double left = a, right = a + kLook / delay;
        const Complex here = L(right);
        const bool crosses = (before.imag() < 0) != (here.imag() < 0) && here.real() < 0;
        before = here;
        if (!crosses) continue;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (left + right);
            ((L(middle).imag() < 0) == (L(left).imag() < 0) ? left : right) = middle;
        }
        largest = std::max(largest, std::abs(L(left)));
    }
    return 1 / largest;
}

/// A resonance that the dead time has turned `turns` times, with an integral: |L| is `top` there and small elsewhere.
struct Resonance {
    OscillatorySopdt plant;
    ParallelPid gains;
    double omega = 0;

    Resonance(double turns, double zeta, double top) {
        plant = {.K = 1, .T = 1, .zeta = zeta, .L = turns * 2 * std::numbers::pi};
        omega = 1;
        gains.Ki = 2 * zeta * top;
    }
    Complex L(double w) const {
        const Complex s(0, w);
        return gains.Ki / s * std::exp(-s * plant.L) / (s * s + 2 * plant.zeta * s + 1.0);
    }
};

// The maximum may lie anywhere between two crossings: one turn has the width 1/L.
TEST(TurningMargins, TheGainMarginIsExactHoweverOftenTheDeadTimeTurns) {
    for (const double turns : {20.0, 70.0, 70.3, 150.55, 400.8, 1000.1})
        for (const double zeta : {2e-5, 3e-4, 2e-3}) {
            const Resonance r(turns, zeta, 0.39);
            if (r.gains.Ki * r.plant.L > kMaxIntegral) continue;  // the integral alone would be unstable
            const LinearPlant plant = *LinearPlant::make(Plant(r.plant));
            const auto loop = Loop::make(plant, r.gains);
            ASSERT_TRUE(loop);
            const double wide = std::max(0.02, 20 * zeta);
            const double near_top = walked([&](double w) { return r.L(w); }, 1 - wide, 1 + wide, r.plant.L),
                         first = walked([&](double w) { return r.L(w); }, 0.2 / r.plant.L, 8 / r.plant.L, r.plant.L);
            EXPECT_NEAR(find_margins(*loop, make_loop_grid(*loop)).gain_margin, std::min(near_top, first), 1e-6)
                << turns << " turns, zeta " << zeta;
        }
}

TEST(TurningMargins, OfALoopThatIsSampledToo) {
    for (const double turns : {70.3, 400.8})
        for (const double zeta : {2e-5, 2e-3}) {
            const Resonance r(turns, zeta, 0.39);
            if (r.gains.Ki * r.plant.L > kMaxIntegral) continue;  // the integral alone would be unstable
            const LinearPlant plant = *LinearPlant::make(Plant(r.plant));
            const SampledLoop loop(plant, {.gains = r.gains, .Ts = 0.9});
            const auto L = [&](double w) { return loop.open_loop(w); };
            const double wide = std::max(0.02, 20 * zeta),
                         min = std::min(walked(L, 1 - wide, 1 + wide, r.plant.L),
                                        walked(L, 0.2 / r.plant.L, 8 / r.plant.L, r.plant.L));
            EXPECT_NEAR(find_margins(loop, make_peak_grid(loop)).gain_margin, min, 1e-6)
                << turns << " turns, zeta " << zeta;
        }
}

}  // namespace
}  // namespace tunewright
