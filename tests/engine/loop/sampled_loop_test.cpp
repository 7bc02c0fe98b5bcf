#include "engine/loop/sampled/sampled_loop.h"

#include <gtest/gtest.h>

#include "engine/evaluation/longest_sample_time.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "engine/tuning/robust/robust.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

LinearPlant fopdt(double K, double T, double L) { return *LinearPlant::make(Fopdt{.K = K, .T = T, .L = L}); }

// Åström and Wittenmark (1997), example 2.8: for K e^(-Ls)/(Ts + 1), d whole samples and a remainder delta, the pulse
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
        EXPECT_TRUE(count_unstable_poles(s).stable());
        return find_peaks(s, make_peak_grid(s)).S.value;
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

/// A robust design for a random plant, with its loop's peak.
struct Design {
    LinearPlant plant;
    ParallelPid gains;
    Peak S;
};

std::optional<Design> random_design(std::uint64_t seed, bool resonant) {
    const auto random = test::random_plant(seed, resonant);
    const auto plant = LinearPlant::make(random.plant);
    RobustOptions options;
    options.Ms = options.Mt = random.M;
    const auto tuned = tune_robust({random.plant, *plant, std::nullopt}, options, {});
    if (!tuned) return std::nullopt;
    const ParallelPid gains = to_parallel(tuned->controller);
    const auto loop = Loop::make(*plant, gains);
    return Design{*plant, gains, find_peaks(*loop, make_peak_grid(*loop)).S};
}

class OfRandomPlants : public testing::TestWithParam<bool> {};

// The quick check compared with the complete peaks on the loop's finest grid.
TEST_P(OfRandomPlants, ALimitIsKeptWhereThePeakIsBelowIt) {
    int kept = 0, exceeded = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto design = random_design(seed, GetParam());
        if (!design) continue;
        for (const double share : {0.02, 0.1, 0.3, 0.7, 1.5}) {
            const SampledLoop loop(design->plant, {.gains = design->gains, .Ts = share / design->S.omega});
            const LoopGrid grid = make_peak_grid(loop);
            const bool stable = count_unstable_poles(loop, grid).stable();
            const double Ms = stable ? find_peaks(loop, grid).S.value : INFINITY;
            for (const double limit : {0.9 * Ms, 0.999 * Ms, 1.001 * Ms, 1.1 * Ms, 1.5 * Ms, 1.5}) {
                if (!(limit > 1) || !std::isfinite(limit)) continue;
                EXPECT_EQ(loop.keeps(limit), Ms <= limit) << seed << ' ' << share << " Ms " << Ms << ' ' << limit;
                ++(Ms <= limit ? kept : exceeded);
            }
        }
    }
    EXPECT_GT(kept, 300);
    EXPECT_GT(exceeded, 300);
}

/// |S| at 400,000 frequencies up to pi/Ts, independent of the loop's own grid.
double densely_scanned_Ms(const SampledLoop& loop) {
    constexpr int kPoints = 400'000;
    double largest = 0;
    for (int i = 0; i <= kPoints; ++i) {
        const double omega = loop.highest_frequency() * std::pow(1e-5, static_cast<double>(i) / kPoints);
        largest = std::max(largest, std::abs(loop.at(omega).S));
    }
    return largest;
}

// On the flank of an antiresonance L passes near -1 between two frequencies that do not show it: |S| is small where |L|
// is large, and near 1 where L is small.
TEST(SampledLoop, AHumpBesideAnAntiresonanceBreaksALimit) {
    const double zero = 7.74e-4, pole = 4.98e-4, w = 1.466;
    Zpk zpk;
    zpk.K = 297 * 0.1307 * 0.06288 * 19.21;
    test::add_pair(zpk.zeros, 1, zero);
    test::add_pair(zpk.poles, w, pole);
    for (const double lag : {0.1307, 0.06288, 19.21}) zpk.poles.emplace_back(-lag);
    const LinearPlant plant = *LinearPlant::make(zpk);
    const ParallelPid gains{
        .Kp = 2.777, .Ki = 0.216, .Kd = 0.519, .filter = {.type = FilterType::derivative, .Tf = 0.00489}};
    int stable = 0;
    for (const double Ts : {0.003, 0.006, 0.01, 0.02, 0.03, 0.04}) {
        const SampledLoop loop(plant, {.gains = gains, .Ts = Ts});
        if (!count_unstable_poles(loop).stable()) continue;
        ++stable;
        const double Ms = densely_scanned_Ms(loop);
        EXPECT_NEAR(loop.sensitivity_peak().value / Ms, 1, 1e-4) << Ts;
        for (const double share : {0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.9, 0.99})
            EXPECT_FALSE(loop.keeps(std::max(share * Ms, 1.01))) << Ts << " Ms " << Ms << ' ' << share;
        EXPECT_TRUE(loop.keeps(1.01 * Ms)) << Ts;
    }
    EXPECT_GT(stable, 3);
}

TEST_P(OfRandomPlants, TheLongestSampleTimeIsWhereThePeakComesToItsLimit) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto design = random_design(seed, GetParam());
        if (!design || !(design->S.omega > 0)) continue;
        const auto Ts = longest_sample_time(design->plant, design->gains, design->S.value, design->S.omega, 1.05);
        if (!Ts) continue;
        const auto Ms = [&](double sample_time) {
            const SampledLoop loop(design->plant, {.gains = design->gains, .Ts = sample_time});
            return loop.sensitivity_peak().value / design->S.value;
        };
        EXPECT_NEAR(Ms(*Ts), 1.05, 1.1e-3) << seed;
        EXPECT_LE(Ms(0.6 * *Ts), 1.05) << seed;
        ++found;
    }
    EXPECT_GT(found, 30);
}

INSTANTIATE_TEST_SUITE_P(SampledLoop, OfRandomPlants, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& resonant) {
                             return resonant.param ? "Resonant" : "WellDamped";
                         });

TEST(SampledLoop, LosesStabilityWhereItsGainMarginSays) {
    const LinearPlant plant = fopdt(1, 1, 0.5);
    for (const double Ts : {0.05, 0.2, 0.45, 1.1}) {
        ParallelPid gains = to_parallel({.Kp = 0.5, .Ti = 1.0});
        const SampledLoop s(plant, {.gains = gains, .Ts = Ts});
        const Margins m = find_margins(s, make_peak_grid(s));
        for (const double share : {0.999, 1.001}) {
            ParallelPid more = gains;
            more.Kp *= share * m.gain_margin;
            more.Ki *= share * m.gain_margin;
            const SampledLoop at(plant, {.gains = more, .Ts = Ts});
            EXPECT_EQ(count_unstable_poles(at).unstable_poles, share < 1 ? 0 : 2) << Ts << ' ' << m.gain_margin;
        }
    }
}

}  // namespace
}  // namespace tunewright
