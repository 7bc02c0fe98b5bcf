#include <gtest/gtest.h>

#include "engine/loop/margins.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "tests/engine/loop/sampled_cases.h"

namespace tunewright {
namespace {

using namespace test;

struct RandomLoop {
    std::string name;
    OwnPlant own;
    LinearPlant plant;
    SampledPid law;
};

/// Any random plant of the searches with any law, stable or not: up to `max` samples of dead time and five of delay.
RandomLoop random_loop(int index, int max = 15) {
    Random random(1000 + static_cast<std::uint64_t>(index));
    RandomPlant drawn = random_plant(static_cast<std::uint64_t>(index), index % 4 == 0);
    double slowest = 0;
    for (const auto pole : drawn.plant.poles)
        if (pole != 0.0) slowest = std::max(slowest, 1 / std::abs(pole));
    if (slowest == 0) slowest = 1;
    SampledPid law;
    law.Ts = slowest * random.log_uniform(0.02, 2);
    drawn.plant.L = law.Ts * (random.one_in(3) ? random.whole(0, max) : random.uniform(0, max));
    law.computation_delay = law.Ts * (random.one_in(2) ? 0 : random.uniform(0, 5));
    law.integral = static_cast<IntegralRule>(random.whole(0, 2));
    law.derivative = static_cast<DerivativeRule>(random.whole(0, 5));
    law.slope_samples = random.whole(1, 6);
    const std::vector<double> den = with_roots(drawn.plant.poles, 1),
                              num = with_roots(drawn.plant.zeros, drawn.plant.K);
    LinearPlant plant = *LinearPlant::make(drawn.plant);
    ParallelPid& g = law.gains;
    g.Kp = random.log_uniform(0.02, 3) / std::abs(plant.low_frequency_gain());
    if (plant.low_frequency_gain() < 0) g.Kp = -g.Kp;
    if (random.one_in(10)) g.Kp = -g.Kp;
    g.Ki = random.one_in(6) ? 0 : g.Kp / (slowest * random.log_uniform(0.2, 5));
    g.Kd = random.one_in(3) ? 0 : g.Kp * slowest * random.log_uniform(0.02, 1);
    if (g.Ki != 0 && random.one_in(8)) g.Kp = 0;
    const int filter = random.whole(0, 3);
    // From below half a sample on: there the forward rule's filter is unstable.
    g.filter = {static_cast<FilterType>(filter), filter == 0 ? 0.0 : law.Ts * random.log_uniform(0.3, 6)};
    return {drawn.description, OwnPlant(num, den), std::move(plant), law};
}

Eigen::VectorXcd eigenvalues(const RandomLoop& loop, double factor = 1) {
    SampledPid law = loop.law;
    law.gains.Kp *= factor;
    law.gains.Ki *= factor;
    law.gains.Kd *= factor;
    return OwnLoop(loop.own, loop.plant.dead_time(), law).eigenvalues();
}

int outside(const Eigen::VectorXcd& values) {
    return static_cast<int>(std::count_if(values.begin(), values.end(), [](auto z) { return std::abs(z) > 1; }));
}

/// Distance of the nearest eigenvalue from the circle.
double distance(const Eigen::VectorXcd& values) {
    double nearest = INFINITY;
    for (const auto z : values) nearest = std::min(nearest, std::abs(std::abs(z) - 1));
    return nearest;
}

constexpr int kLoops = 500;

// The eigenvalues of a matrix of up to 45 rows are accurate to 1e-7 near the circle; at larger distances they are
// distinguished.
TEST(SampledStability, CountsTheEigenvaluesOutsideTheCircle) {
    int stable = 0, compared = 0;
    for (int i = 0; i < kLoops; ++i) {
        const RandomLoop loop = random_loop(i);
        SCOPED_TRACE(loop.name + ", " + std::to_string(i));
        const Eigen::VectorXcd values = eigenvalues(loop);
        if (distance(values) < 1e-6) continue;
        ++compared;
        const StabilityCount count = count_unstable_poles(SampledLoop(loop.plant, loop.law));
        EXPECT_EQ(count.unstable_poles, outside(values));
        EXPECT_FALSE(count.on_the_boundary);
        stable += count.stable();
    }
    EXPECT_GT(stable, kLoops / 4);
    EXPECT_LT(stable, 3 * kLoops / 4);
    EXPECT_GT(compared, kLoops - 20);
}

// Between two points of a grid the dead time may turn L more than once, which must not count as no turn.
TEST(SampledStability, CountsThemBehindAHundredSamplesToo) {
    int many = 0;
    for (int i = 0; i < 150; ++i) {
        const RandomLoop loop = random_loop(i, 100);
        const Eigen::VectorXcd values = eigenvalues(loop);
        if (distance(values) < 1e-6) continue;
        EXPECT_EQ(count_unstable_poles(SampledLoop(loop.plant, loop.law)).unstable_poles, outside(values)) << i;
        many += outside(values) > 20;
    }
    EXPECT_GT(many, 10);
}

/// With all gains scaled by a factor the loop is stable between the gain margins and not stable beyond each of them.
void check_gain_margins(const RandomLoop& loop) {
    const SampledLoop sampled(loop.plant, loop.law);
    const Margins margins = find_margins(sampled, make_peak_grid(sampled));
    const auto unstable = [&](double factor) { return outside(eigenvalues(loop, factor)) > 0; };
    const double high = std::isfinite(margins.gain_margin) ? margins.gain_margin : 1e4;
    if (std::isfinite(margins.gain_margin)) {
        EXPECT_TRUE(unstable(1 + (high - 1) * 1.0001)) << high;
    }
    for (const double share : {0.05, 0.2, 0.5, 0.8, 0.9999})
        EXPECT_FALSE(unstable(1 + (high - 1) * share)) << high << ' ' << share;
    const double low = margins.gain_margin_low;
    if (low > 0) {
        EXPECT_TRUE(unstable(low * 0.9999)) << low;
    }
    for (const double share : {0.0001, 0.1, 0.5, 0.9}) {
        const double factor = low > 0 ? low + (1 - low) * share : 1e-3 + share;
        EXPECT_FALSE(unstable(factor) && distance(eigenvalues(loop, factor)) > 1e-9) << low << ' ' << factor;
    }
}

TEST(SampledStability, GainMarginsAreWhereAnEigenvalueReachesTheCircle) {
    int looked_at = 0;
    for (int i = 0; i < kLoops; ++i) {
        const RandomLoop loop = random_loop(i);
        SCOPED_TRACE(loop.name + ", " + std::to_string(i));
        if (outside(eigenvalues(loop)) > 0) continue;
        ++looked_at;
        check_gain_margins(loop);
    }
    EXPECT_GT(looked_at, 100);
    // The loops of the known plants, which include some that a smaller gain makes unstable.
    Random random(5);
    int found = 0;
    for (const KnownPlant& known : known_plants())
        for (int i = 0; i < 4; ++i) {
            if (known.name.find("unstable") == std::string::npos && !known.integrating && i > 0) continue;
            const auto c = random_case(known, random, 0.1, i * 170, i % 2 * 120, i % 3, (i + found) % 6, found % 4);
            if (!c) continue;
            SCOPED_TRACE(c->name);
            ++found;
            check_gain_margins({c->name, c->own, *LinearPlant::make(c->plant), c->law});
        }
    EXPECT_GT(found, 50);
}

/// L from the pulse response, at an angle of z.
std::complex<double> open_loop(const PulseResponse& pulse, double angle) { return 1.0 / sum_at(pulse.S, angle) - 1.0; }

// The crossings of |L| = 1 by bisection between 4000 angles, L from the samples after a pulse.
TEST(SampledStability, PhaseAndDelayMarginsAreThoseOfThePulsesSpectrum) {
    int crossed = 0;
    Random random(77);
    for (const KnownPlant& known : known_plants()) {
        const auto c = random_case(known, random, 0.1, crossed % 2 * 300, 120, crossed % 3, crossed % 6, crossed % 4);
        if (!c) continue;
        SCOPED_TRACE(c->name);
        double phase = INFINITY, delay = INFINITY;
        const auto log_gain = [&](double a) { return std::log(std::abs(open_loop(c->pulse, a))); };
        for (int k = 1; k < 2000; ++k) {
            double a = std::numbers::pi * std::pow(k / 2000.0, 2), b = std::numbers::pi * std::pow((k + 1) / 2000.0, 2);
            const bool rises = log_gain(a) < 0;
            if (rises == (log_gain(b) < 0)) continue;
            for (int i = 0; i < 50; ++i) ((log_gain(0.5 * (a + b)) < 0) == rises ? a : b) = 0.5 * (a + b);
            double lag = std::arg(open_loop(c->pulse, a)) + std::numbers::pi;
            phase = std::min({phase, lag, 2 * std::numbers::pi - lag});
            delay = std::min(delay, lag * c->law.Ts / a);
        }
        const LinearPlant plant = *LinearPlant::make(c->plant);
        const SampledLoop loop(plant, c->law);
        const Margins margins = find_margins(loop, make_peak_grid(loop));
        if (!std::isfinite(phase)) {
            EXPECT_FALSE(std::isfinite(margins.phase_margin));
            continue;
        }
        ++crossed;
        EXPECT_NEAR(margins.phase_margin, phase, 1e-6);
        EXPECT_NEAR(margins.delay_margin, delay, 1e-6 * delay);
    }
    EXPECT_GT(crossed, 15);
}

}  // namespace
}  // namespace tunewright
