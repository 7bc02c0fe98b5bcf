#include "engine/numerics/extremum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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

double bowl(const std::vector<double>& x) { return std::pow(x[0] - 1, 2) + std::abs(x[1] + 2); }

TEST(LocalMinimum, IsFoundWhereTheFunctionHasAKink) {
    for (const auto search : {LocalSearch::nelder_mead, LocalSearch::subplex}) {
        const auto f = [](const std::vector<double>& x, bool&) { return bowl(x); };
        const auto best = find_local_minimum(search, f, {0, 0}, {.step = {0.5, 0.5}, .tolerance = 1e-10});
        EXPECT_NEAR(best.x[0], 1, 1e-3);
        EXPECT_NEAR(best.x[1], -2, 1e-4);
        EXPECT_EQ(best.value, bowl(best.x));
    }
}

TEST(LocalMinimum, AnswersTheBestPointMetWhenItIsStopped) {
    int evaluations = 0;
    double least = HUGE_VAL;
    const auto f = [&](const std::vector<double>& x, bool& stop) {
        stop = ++evaluations == 7;
        least = std::min(least, bowl(x));
        return bowl(x);
    };
    const auto best = find_local_minimum(LocalSearch::nelder_mead, f, {0, 0}, {.step = {0.5, 0.5}});
    EXPECT_EQ(evaluations, 7);
    EXPECT_EQ(best.value, least);
}

TEST(Explore, KeepsEveryPointOfTheBoxInOrder) {
    std::vector<double> values;
    const auto f = [&](const std::vector<double>& x, bool&) { return values.emplace_back(bowl(x)); };
    const auto met = explore(f, {{-4, -4}, {4, 4}}, 200);
    ASSERT_EQ(met.size(), values.size());
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < met.size(); ++i) {
        EXPECT_EQ(met[i].value, values[i]);
        for (const double x : met[i].x) EXPECT_LE(std::abs(x), 4);
        least = std::min(least, met[i].value);
    }
    EXPECT_LT(least, 0.1);
}

}  // namespace
}  // namespace tunewright
