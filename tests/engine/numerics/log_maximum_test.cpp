#include "engine/numerics/log_maximum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tunewright {
namespace {

TEST(LogMaximum, FindsASharpResonance) {
    // |1/(1 - w^2 + 2 j zeta w)| is largest at sqrt(1 - 2 zeta^2).
    const double zeta = 1e-3;
    const auto gain = [&](double w) { return 1 / std::hypot(1 - w * w, 2 * zeta * w); };
    const auto peak = log_maximum(gain, 0.9, {0.99, gain(0.99)}, 1.05);
    EXPECT_NEAR(peak.value * 2 * zeta * std::sqrt(1 - zeta * zeta), 1, 1e-11);
    EXPECT_NEAR(peak.x, std::sqrt(1 - 2 * zeta * zeta), 1e-7);
}

TEST(LogMaximum, NeverAnswersLessThanWhatIsKnown) {
    // Two peaks: the known point stands on the higher, narrow one.
    const auto f = [](double x) { return std::exp(-1e8 * std::pow(x - 1.5, 2)) + 0.5 * std::exp(-std::pow(x - 3, 2)); };
    const auto peak = log_maximum(f, 1, {1.5, f(1.5)}, 4);
    EXPECT_GE(peak.value, f(1.5));
}

}  // namespace
}  // namespace tunewright
