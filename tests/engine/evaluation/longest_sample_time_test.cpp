// At the longest sample time and all shorter ones the stated limit holds, even if Ms is a jagged function of the sample
// time: on plants that are mostly dead time, at dead times of whole samples and in dense steps between them.
#include "engine/evaluation/longest_sample_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <stop_token>
#include <vector>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/loop/stability.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

constexpr int kLoops = 40, kSteps = 150;
constexpr double kFactor = 1.05;
// Steps of the search are up to 1 % where Ms is near its limit: a hump between them may exceed the limit by this
// factor.
constexpr double kHump = 1.01;

class Random {
public:
    explicit Random(unsigned seed) : random_(seed) {}
    double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
    double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
    bool one_in(unsigned n) { return random_() % n == 0; }

private:
    std::mt19937 random_;
};

struct StableLoop {
    LinearPlant plant;
    ParallelPid gains;
    Peak S;
};

std::optional<StableLoop> drawn(Random& random, const Plant& plant) {
    StableLoop drawn{*LinearPlant::make(plant), {}, {}};
    const double time = drawn.plant.time_scale();
    ParallelPid& g = drawn.gains;
    g.Kp = random.one_in(6) ? 0 : random.log_uniform(0.05, 3);
    g.Ki = random.log_uniform(0.05, 3) / (time * random.log_uniform(0.1, 2));
    if (g.Kp > 0 && random.one_in(2)) {
        g.Kd = g.Kp * time * random.log_uniform(0.02, 0.3);
        g.filter = {FilterType::derivative, 0.1 * g.Kd / g.Kp};
    }
    const auto loop = Loop::make(drawn.plant, g);
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    drawn.S = find_peaks(*loop, make_peak_grid(*loop)).S;
    if (drawn.S.value > 2.5 || drawn.S.value < 1.1 || !(drawn.S.omega > 0) || !std::isfinite(drawn.S.omega))
        return std::nullopt;
    return drawn;
}

void holds_below(const StableLoop& loop) {
    const auto Ts = longest_sample_time(loop.plant, loop.gains, loop.S.value, loop.S.omega, kFactor);
    ASSERT_TRUE(Ts);
    const double L = loop.plant.dead_time();
    const auto keeps = [&](double h, double factor) {
        return SampledLoop(loop.plant, {.gains = loop.gains, .Ts = h}).keeps(factor * loop.S.value);
    };
    for (int i = 1; i <= kSteps; ++i)
        EXPECT_TRUE(keeps(*Ts * (0.02 + 0.98 * i / kSteps), kFactor * kHump)) << "at " << i << " of " << kSteps;
    for (double n = std::ceil(L / *Ts); n < 40; ++n)
        EXPECT_TRUE(keeps(L / n, kFactor * kHump)) << "with a dead time of " << n << " samples";
    EXPECT_FALSE(keeps(*Ts, kFactor * 0.998)) << "Ms is not at its limit there";
}

TEST(LongestSampleTimeOfDeadTime, AllShorterOnesKeepItsPromise) {
    Random random(17);
    for (int made = 0; made < kLoops;) {
        const double L = random.log_uniform(1, 60);
        const Plant plant = made % 2 == 0 ? Plant(Fopdt{.K = 1, .T = 1, .L = L})
                                          : Plant(Sopdt{.K = 1, .T1 = 1, .T2 = random.uniform(0.1, 1), .L = L});
        const auto loop = drawn(random, plant);
        if (!loop) continue;
        ++made;
        SCOPED_TRACE(testing::Message() << "loop " << made << ", L " << L << ", Kp " << loop->gains.Kp << ", Ki "
                                        << loop->gains.Ki << ", Kd " << loop->gains.Kd);
        holds_below(*loop);
    }
}

/// A design at its limit often has two peaks of |S| of one height: whichever counts as the peak, the sample time is the
/// same.
TEST(LongestSampleTimeOfDeadTime, OfTwoEqualPeaksEitherMayBeTheFirst) {
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 4});
    const TuningProblem problem{Fopdt{.K = 1, .T = 1, .L = 4}, plant, std::nullopt};
    const TuningMethod& robust = *find_method("robust");
    const auto tuned = robust.tune(problem, with_defaults(robust.options, {}), {});
    ASSERT_TRUE(tuned);
    const ParallelPid gains = to_parallel(tuned->controller);
    const auto loop = Loop::make(plant, gains);
    ASSERT_TRUE(loop);
    std::vector<double> tops;
    const auto S = [&](double omega) { return std::abs(loop->at(omega).S); };
    for (double omega = 0.05; omega < 20; omega *= 1.002)
        if (S(omega) > 1.39 && S(omega) > S(omega / 1.002) && S(omega) > S(omega * 1.002)) tops.push_back(omega);
    ASSERT_GE(tops.size(), 2U);
    std::optional<double> first;
    for (const double omega : tops) {
        const auto Ts = longest_sample_time(plant, gains, 1.4, omega, kFactor);
        ASSERT_TRUE(Ts);
        EXPECT_NEAR(*Ts, first.value_or(*Ts), 2e-3 * *Ts) << "from the peak at " << omega;
        first = *Ts;
    }
}

/// A plant of a lag, a dead time and a mode of natural frequency `omega` in series.
LinearPlant with_mode(double omega, double zeta) {
    const double w = 1 / omega;
    return *LinearPlant::make(
        TransferFunction{.num = {2}, .den = {10 * w * w, w * w + 20 * zeta * w, 10 + 2 * zeta * w, 1}, .L = 3});
}

/// A mode far above the loop does not affect it: the sample time is that of the plant without it, and is found.
TEST(LongestSampleTimeOfModes, OneFarBeyondTheLoopDoesNotCount) {
    const ParallelPid gains =
        to_parallel(IdealPid{.Kp = 0.7, .Ti = 9, .Td = 1, .filter = {FilterType::measurement_first_order, 0.3}});
    const auto found = [&](const LinearPlant& plant) {
        const auto loop = Loop::make(plant, gains);
        const Peak S = find_peaks(*loop, make_peak_grid(*loop)).S;
        return longest_sample_time(plant, gains, S.value, S.omega, kFactor);
    };
    const auto without = found(*LinearPlant::make(Fopdt{.K = 2, .T = 10, .L = 3}));
    ASSERT_TRUE(without);
    for (const double omega : {1e5, 1e6, 1e7}) {
        const auto with = found(with_mode(omega, 0.01));
        ASSERT_TRUE(with) << with.why;
        EXPECT_NEAR(*with / *without, 1, 0.01) << omega;
    }
}

/// A mode without damping is sampled badly at many sample times: the search ends, and gives the reason.
TEST(LongestSampleTimeOfModes, ASearchThatWouldNotEndSaysSo) {
    const LinearPlant plant = with_mode(1e6, 0);
    const ParallelPid gains = to_parallel(IdealPid{.Kp = 0.3, .Ti = 9});
    const auto Ts = longest_sample_time(plant, gains, 1.6, 0.3, kFactor);
    EXPECT_FALSE(Ts);
    EXPECT_FALSE(Ts.why.empty());
}

TEST(LongestSampleTimeOfModes, AStoppedSearchEndsAtItsNextLook) {
    std::stop_source source;
    source.request_stop();
    const LinearPlant plant = with_mode(3, 0.02);
    const ParallelPid gains = to_parallel(IdealPid{.Kp = 0.3, .Ti = 9});
    const auto loop = Loop::make(plant, gains);
    const Peak S = find_peaks(*loop, make_peak_grid(*loop)).S;
    EXPECT_TRUE(longest_sample_time(plant, gains, S.value, S.omega, kFactor));
    const auto stopped = longest_sample_time(plant, gains, S.value, S.omega, kFactor, source.get_token());
    EXPECT_FALSE(stopped);
    EXPECT_NE(stopped.why.find("stopped"), std::string::npos);
}

}  // namespace
}  // namespace tunewright
