#include "engine/loop/sampled/sampled_loop.h"

#include <gtest/gtest.h>

#include "engine/evaluation/longest_sample_time.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

LinearPlant fopdt(double K, double T, double L) { return *LinearPlant::make(Fopdt{.K = K, .T = T, .L = L}); }

// Astrom and Wittenmark (1997), example 2.8: of K e^(-Ls)/(Ts + 1), d whole samples and a rest delta, the pulse
// transfer function K z^-d ((1 - a1) + (a1 - a) z^-1)/(z - a), a = e^(-Ts/T), a1 = e^(-(Ts - delta)/T).
TEST(HeldPlant, AFirstOrderLagHasItsClosedForm) {
    for (const double Ts : {0.01, 0.3, 1.0, 2.5, 7.0})
        for (const double L : {0.0, 0.4, 1.0, 3.7}) {
            const LinearPlant plant = fopdt(2, 5, L);
            const HeldPlant held(plant, Ts, 0);
            const double d = std::floor(L / Ts + 1e-12), delta = std::max(0.0, L - d * Ts);
            const double a = std::exp(-Ts / 5), a1 = std::exp(-(Ts - delta) / 5);
            for (const double share : {1e-4, 0.01, 0.2, 0.9, 1.0}) {
                const double omega = share * std::numbers::pi / Ts;
                const Complex z = std::polar(1.0, omega * Ts);
                const Complex expected = 2.0 * std::pow(z, -d) * ((1 - a1) + (a1 - a) / z) / (z - a);
                EXPECT_LT(std::abs(held.at(omega) - expected), 1e-12 * std::abs(expected)) << Ts << ' ' << L;
            }
        }
}

TEST(SampledLoop, TendsToTheContinuousLoopAsTheSampleTimeFalls) {
    const LinearPlant plant = fopdt(1, 1, 0.5);
    ParallelPid gains = to_parallel({.Kp = 1.1, .Ti = 1.2, .Td = 0.15, .filter = {FilterType::derivative, 0.05}});
    const Loop loop = *Loop::make(plant, gains);
    const double Ms = find_peaks(loop, make_peak_grid(loop)).S.value;
    const auto sampled = [&](double Ts) {
        const SampledLoop s(plant, {.gains = gains, .Ts = Ts});
        EXPECT_TRUE(s.count_unstable_poles().stable());
        return s.peaks(s.grid()).S.value;
    };
    const double e1 = sampled(2e-3) - Ms, e2 = sampled(1e-3) - Ms;
    EXPECT_NEAR(e1 / e2, 2, 0.05);  // of first order
    EXPECT_LT(std::abs(e2), 2e-3);
    StepResponse response = simulate_sampled(plant, {.gains = gains, .Ts = 1e-3}, {}, {0, 1}, {});
    EXPECT_TRUE(response.settles);
    const StepResponse exact = simulate_linear(plant, gains, {0, 1}, {});
    // Neither overshoots: both integrals are Ti/Kp.
    EXPECT_NEAR(integral_of_absolute_error(response.nodes, 0, response.error_integral_final),
                integral_of_absolute_error(exact.nodes, 0, exact.error_integral_final), 1e-6);
    const auto longest = longest_sample_time(plant, gains, Ms, find_peaks(loop, make_peak_grid(loop)).S.omega, 1.05);
    ASSERT_TRUE(longest);
    EXPECT_NEAR(sampled(*longest) / Ms, 1.05, 1e-3);
}

TEST(SampledLoop, LosesStabilityWhereItsGainMarginSays) {
    const LinearPlant plant = fopdt(1, 1, 0.5);
    for (const double Ts : {0.05, 0.2, 0.45, 1.1}) {
        ParallelPid gains = to_parallel({.Kp = 0.5, .Ti = 1.0});
        const SampledLoop s(plant, {.gains = gains, .Ts = Ts});
        const Margins m = s.margins(s.grid());
        for (const double share : {0.999, 1.001}) {
            ParallelPid more = gains;
            more.Kp *= share * m.gain_margin;
            more.Ki *= share * m.gain_margin;
            const SampledLoop at(plant, {.gains = more, .Ts = Ts});
            EXPECT_EQ(at.count_unstable_poles().unstable_poles, share < 1 ? 0 : 2) << Ts << ' ' << m.gain_margin;
        }
    }
}

}  // namespace
}  // namespace tunewright
