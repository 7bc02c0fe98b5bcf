#include "engine/numerics/sign_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RootBetween, FindsARootToItsTolerance) {
    const auto f = [](double x) { return std::cos(x) - x; };
    EXPECT_NEAR(root_between(f, 0, 1, f(0), f(1), 1e-14), 0.7390851332151607, 2e-14);
    EXPECT_NEAR(root_between(f, 1, 0, f(1), f(0), 1e-14), 0.7390851332151607, 2e-14);
}

TEST(RootBetween, TakesAnEndThatIsARoot) {
    const auto f = [](double x) { return x - 2; };
    EXPECT_EQ(root_between(f, 2, 3, f(2), f(3), 1e-12), 2);
    EXPECT_EQ(root_between(f, 1, 2, f(1), f(2), 1e-12), 2);
}

TEST(LogRoot, HalvesTheIntervalWhereAValueIsNotFinite) {
    const auto f = [](double x) { return x < 3 ? -kInfinity : x - 5; };
    EXPECT_NEAR(log_root(f, 1, 1e6, f(1), f(1e6), 1e-13), 5, 1e-11);
    const auto jump = [](double x) { return x < 7 ? -1.0 : std::nan(""); };
    EXPECT_NEAR(log_root(jump, 1, 1e6, jump(1), jump(1e6), 1e-13), 7, 1e-11);
}

TEST(FirstPositive, EndsOnTheFirstNumberAboveZero) {
    const auto f = [](double x) { return x - 0.3; };
    const double x = first_positive(f, 0, 1, f(0), f(1));
    EXPECT_GT(f(x), 0);
    EXPECT_LE(f(x), 4 * std::numeric_limits<double>::epsilon());
}

TEST(FirstCrossing, SeesAnExcursionThatIsOverAtTheEnd) {
    const auto g = [](double s) { return 0.1 - (s - 0.4) * (s - 0.4); };
    const auto s = first_crossing(g, 0, 1);
    ASSERT_TRUE(s.has_value());
    EXPECT_NEAR(*s, 0.4 - std::sqrt(0.1), 1e-12);
    EXPECT_FALSE(first_crossing([](double) { return -1.0; }, 0, 1).has_value());
}

}  // namespace
}  // namespace tunewright
