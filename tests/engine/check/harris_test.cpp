// The index against loops whose minimum variance is known exactly: the error is an impulse response that is known,
// driven by white noise.
#include "engine/check/harris.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

struct KnownLoop {
    std::vector<double> error;
    int delay = 1;
    double exact = 0;  ///< minimum variance over variance
};

/// A closed loop: a load that drifts as a lag does, a first-order plant with dead time, a PI controller. The minimum
/// variance over the first `delay` terms of the impulse response from the noise to the error.
KnownLoop known_loop(std::uint64_t seed) {
    test::Random random(seed);
    const int delay = random.whole(1, 12);
    const double a = std::exp(-1 / random.log_uniform(2, 30)), phi = std::exp(-1 / random.log_uniform(3, 200));
    const double K = random.uniform(0.5, 2), Ti = std::max(2.0, -1 / std::log(a));
    const double gain = random.uniform(0.15, 0.6) * Ti / (K * (delay + 1));
    const auto run = [&](std::size_t n, const auto& noise) {
        std::vector<double> u(n + static_cast<std::size_t>(delay), 0.0), error(n);
        double x = 0, load = 0, integral = 0;
        for (std::size_t i = 0; i < n; ++i) {
            load = phi * load + noise(i);
            // u at the index i + delay - 1 acts on x from row i + delay on.
            x = a * x + (1 - a) * K * u[i];
            error[i] = -(x + load);
            integral += gain * error[i] / Ti;
            if (i + static_cast<std::size_t>(delay) < u.size())
                u[i + static_cast<std::size_t>(delay)] = gain * error[i] + integral;
        }
        return error;
    };
    KnownLoop loop;
    loop.delay = delay;
    const std::size_t settled = 4000;
    const auto psi = run(settled, [](std::size_t i) { return i == 0 ? 1.0 : 0.0; });
    double first = 0, all = 0;
    for (std::size_t k = 0; k < psi.size(); ++k) {
        all += psi[k] * psi[k];
        if (k < static_cast<std::size_t>(delay)) first += psi[k] * psi[k];
    }
    loop.exact = first / all;
    loop.error = run(2500, [&](std::size_t) { return normal(random); });
    loop.error.erase(loop.error.begin(), loop.error.begin() + 500);
    return loop;
}

TEST(Harris, TheRangeHoldsTheExactRatioOnNineteenOfTwentyLoops) {
    int held = 0, loops = 0;
    double width = 0;
    for (std::uint64_t seed = 1; loops < 200; ++seed) {
        const KnownLoop loop = known_loop(seed);
        if (!(loop.exact > 0.02) || !std::isfinite(loop.exact)) continue;  // an unstable or a drifting loop
        ++loops;
        const std::vector<int> delays = {loop.delay};
        const auto index = harris_index(loop.error, delays);
        held += index.low <= loop.exact && loop.exact <= index.high ? 1 : 0;
        width += index.high - index.low;
        EXPECT_LE(index.low, index.high);
    }
    EXPECT_GE(held, 190);
    EXPECT_LT(width / loops, 0.25) << "a range that says nothing holds everything";
}

TEST(Harris, WhiteNoiseCannotBeImproved) {
    test::Random random(5);
    std::vector<double> e(3000);
    for (double& value : e) value = normal(random);
    const std::vector<int> delays = {1, 5};
    const auto index = harris_index(e, delays);
    EXPECT_GT(index.low, 0.9);
    EXPECT_LE(index.high, 1);
    EXPECT_LE(index.by_delay[0], index.by_delay[1]);
}

/// A first-order autoregression of 0.9: the share of the first b terms is 1 - 0.81^b.
TEST(Harris, OfAFirstOrderSeriesIsKnown) {
    test::Random random(6);
    std::vector<double> e(20000);
    double x = 0;
    for (double& value : e) value = x = 0.9 * x + normal(random);
    const std::vector<int> delays = {1, 3, 8};
    const auto index = harris_index(e, delays);
    for (std::size_t k = 0; k < delays.size(); ++k)
        EXPECT_NEAR(index.by_delay[k], 1 - std::pow(0.81, delays[k]), 0.04) << delays[k];
}

}  // namespace
}  // namespace tunewright::check
