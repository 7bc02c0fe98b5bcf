#include "engine/evaluation/evaluate_sampled.h"
#include "engine/evaluation/longest_sample_time.h"

#include <gtest/gtest.h>

#include "engine/loop/loop.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/loop/stability.h"
#include "tests/engine/loop/sampled_cases.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using namespace test;

struct ContinuousLoop {
    std::string name;
    LinearPlant plant;
    OwnPlant own;
    ParallelPid gains;
    Peak S;
};

/// Loops of the searches' random plants with random gains, stable, with Ms below 3.
std::vector<ContinuousLoop> continuous_loops(int count) {
    std::vector<ContinuousLoop> found;
    Random random(11);
    for (std::uint64_t seed = 1; static_cast<int>(found.size()) < count; ++seed) {
        const RandomPlant drawn = random_plant(seed, seed % 4 == 0);
        LinearPlant plant = *LinearPlant::make(drawn.plant);
        for (int i = 0; i < 200; ++i) {
            ParallelPid g;
            g.Kp = random.log_uniform(0.05, 10) / plant.low_frequency_gain();
            g.Ki = random.one_in(8) ? 0 : g.Kp / (plant.time_scale() * random.log_uniform(0.2, 3));
            const bool derivative = random.one_in(2);
            g.Kd = derivative ? g.Kp * plant.time_scale() * random.log_uniform(0.03, 0.3) : 0;
            if (derivative)
                g.filter = {static_cast<FilterType>(random.whole(1, 3)), g.Kd / g.Kp / random.uniform(2, 10)};
            const auto loop = Loop::make(plant, g);
            if (!loop || !count_unstable_poles(*loop).stable()) continue;
            const Peak S = find_peaks(*loop, make_peak_grid(*loop)).S;
            if (S.value > 3 || S.value < 1.05 || !std::isfinite(S.omega)) continue;
            found.push_back({drawn.description, plant,
                             OwnPlant(with_roots(drawn.plant.zeros, drawn.plant.K), with_roots(drawn.plant.poles, 1)),
                             g, S});
            break;
        }
    }
    return found;
}

double sampled_Ms(const ContinuousLoop& loop, double Ts) {
    const SampledLoop sampled(loop.plant, {.gains = loop.gains, .Ts = Ts});
    return count_unstable_poles(sampled).stable() ? find_peaks(sampled, make_peak_grid(sampled)).S.value : INFINITY;
}

// At the longest sample time the sampled loop's Ms is the allowed one, to 1e-3, and at shorter sample times it is
// not higher. The samples after a pulse confirm it.
TEST(LongestSampleTime, LeavesTheWholeLoopJustItsShareOfMs) {
    int looked_at = 0, by_pulse = 0;
    for (const ContinuousLoop& loop : continuous_loops(100)) {
        SCOPED_TRACE(loop.name);
        const auto Ts = longest_sample_time(loop.plant, loop.gains, loop.S.value, loop.S.omega, 1.05);
        if (!Ts) continue;
        ++looked_at;
        EXPECT_NEAR(sampled_Ms(loop, *Ts) / loop.S.value, 1.05, 1.1e-3) << *Ts * loop.S.omega;
        for (double share = 0.97; share * *Ts > 2e-3 / loop.S.omega; share *= 0.8)
            EXPECT_LT(sampled_Ms(loop, *Ts * share) / loop.S.value, 1.0511) << share;
        const auto pulse =
            pulse_response_of(OwnLoop(loop.own, loop.plant.dead_time(), {.gains = loop.gains, .Ts = *Ts}), 20000,
                              int(loop.plant.dead_time() / *Ts));
        if (!pulse || pulse->S.size() > 3000) continue;
        ++by_pulse;
        EXPECT_NEAR(peaks_of(*pulse).S / loop.S.value, 1.05, 1.1e-3);
    }
    EXPECT_GT(looked_at, 90);
    EXPECT_GT(by_pulse, 50);
}

// For K Kp = 0.02, |S| is below 1/(1 - 0.02) at any sample time: none is too long.
TEST(LongestSampleTime, IsNoneWhereNothingIsTooLong) {
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 1});
    const ParallelPid gains{.Kp = 0.02};
    const Loop loop = *Loop::make(plant, gains);
    const Peak S = find_peaks(loop, make_peak_grid(loop)).S;
    EXPECT_FALSE(longest_sample_time(plant, gains, S.value, S.omega, 1.05));
}

// An unfiltered derivative keeps |L| near 0.6 up to 1/T, and a dead time of a million T turns it without end.
TEST(LongestSampleTime, IsNotLookedForFarBelowTheDeadTime) {
    const double L = 1e6;
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = L});
    const ParallelPid gains = to_parallel({.Kp = 1.2 / L, .Ti = 2 * L, .Td = 0.5 * L});
    const auto Ts = longest_sample_time(plant, gains, 2.5, 0.7, 1.05);
    EXPECT_TRUE(!Ts || *Ts >= L / 3e4);
}

TEST(EvaluateSampled, HasTheFiguresOfTheLoopAndOfItsResponse) {
    const Plant plant = Fopdt{.K = 2, .T = 1, .L = 0.3};
    const SampledPid law{.gains = {.Kp = 0.4, .Ki = 0.5}, .Ts = 0.2};
    EvaluateOptions options;
    options.setpoint_step = -3;
    options.load_step = 0.5;
    const DeviceLoop on_device = *evaluate_sampled(subject_of(plant), law, {}, options);
    const OwnPlant own({2}, {1, 1});
    const BrutePeaks peaks = peaks_of(*pulse_response_of(OwnLoop(own, 0.3, law), 5000, 2));
    EXPECT_NEAR(*on_device.robustness.Ms, peaks.S, 1e-8);
    EXPECT_NEAR(*on_device.robustness.Mt, peaks.T, 1e-8);
    EXPECT_NEAR(*on_device.robustness.Mks, peaks.CS, 1e-8);
    const BruteForce brute{own, 0.3, law};
    const BruteResponse setpoint = brute.respond(-3, 0, -3), load = brute.respond(0, 0.5, 0);
    EXPECT_NEAR(*on_device.performance.setpoint.IAE, setpoint.IAE, 1e-6 * setpoint.IAE);
    EXPECT_NEAR(*on_device.performance.setpoint.TV, setpoint.TV, 1e-6 * setpoint.TV);
    EXPECT_NEAR(*on_device.performance.setpoint.overshoot_percent, std::max(0.0, 100 * (setpoint.y_min / -3 - 1)),
                1e-4);
    EXPECT_NEAR(*on_device.performance.setpoint.first_move, -3 * (0.4 + 0.5 * 0.2), 1e-12);
    EXPECT_NEAR(*on_device.performance.load.IAE, load.IAE, 1e-6 * load.IAE);
    EXPECT_NEAR(*on_device.performance.load.peak, load.y_max, 1e-6);
    ASSERT_TRUE(on_device.responses);
    EXPECT_EQ(on_device.responses->setpoint.t.size(), 400u);
}

}  // namespace
}  // namespace tunewright
