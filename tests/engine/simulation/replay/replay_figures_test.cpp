#include "engine/simulation/replay/replay_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace tunewright {
namespace {

TEST(ReplayFigures, AreThoseCountedByHand) {
    const std::vector<double> r{1, 1, 2, 2, 2}, y{1, 0, 0.5, 2.25, 2}, u{5, 7, 6, 6, 9};
    const ReplayFigures figures = replay_figures(0.5, r, y, u, 0);
    EXPECT_DOUBLE_EQ(figures.IAE, 0.5 * (1 + 1.5 + 0.25));
    EXPECT_DOUBLE_EQ(figures.largest_error, 1.5);
    EXPECT_DOUBLE_EQ(figures.travel, 2 + 1 + 3);
    EXPECT_EQ(figures.reversals, 2);
}

TEST(ReplayFigures, CountTwoReversalsAPeriodAndNoneWithinTheBand) {
    std::vector<double> zero(1001, 0.0), u, drift;
    for (int k = 0; k <= 1000; ++k) {
        u.push_back(std::sin(2 * std::numbers::pi * k / 100));  // ten periods
        drift.push_back(0.01 * k + 0.2 * (k % 2));              // moves back by 0.19 in every other row
    }
    EXPECT_EQ(replay_figures(1, zero, zero, u, 0.1).reversals, 20);
    EXPECT_EQ(replay_figures(1, zero, zero, u, 2.1).reversals, 0);
    EXPECT_EQ(replay_figures(1, zero, zero, drift, 0.25).reversals, 0);
    EXPECT_GT(replay_figures(1, zero, zero, drift, 0.1).reversals, 900);
}

}  // namespace
}  // namespace tunewright
