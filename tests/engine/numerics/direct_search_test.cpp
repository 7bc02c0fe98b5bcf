#include "engine/numerics/optimise/direct_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tunewright {
namespace {

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
    double min = HUGE_VAL;
    const auto f = [&](const std::vector<double>& x, bool& stop) {
        stop = ++evaluations == 7;
        min = std::min(min, bowl(x));
        return bowl(x);
    };
    const auto best = find_local_minimum(LocalSearch::nelder_mead, f, {0, 0}, {.step = {0.5, 0.5}});
    EXPECT_EQ(evaluations, 7);
    EXPECT_EQ(best.value, min);
}

TEST(Explore, KeepsEveryPointOfTheBoxInOrder) {
    std::vector<double> values;
    const auto f = [&](const std::vector<double>& x, bool&) { return values.emplace_back(bowl(x)); };
    const auto met = explore(f, {{-4, -4}, {4, 4}}, 200);
    ASSERT_EQ(met.size(), values.size());
    double min = HUGE_VAL;
    for (std::size_t i = 0; i < met.size(); ++i) {
        EXPECT_EQ(met[i].value, values[i]);
        for (const double x : met[i].x) EXPECT_LE(std::abs(x), 4);
        min = std::min(min, met[i].value);
    }
    EXPECT_LT(min, 0.1);
}

}  // namespace
}  // namespace tunewright
