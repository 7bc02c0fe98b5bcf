// The defaults and tolerances of one table, which apply to every method without values of its own.
#include "engine/tuning/limits.h"

#include <gtest/gtest.h>

#include "engine/number_text.h"
#include "engine/request/ranking.h"
#include "engine/tuning/device/device_loop.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/robust/frontier.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright {
namespace {

double described(const char* method, const std::string& option) {
    for (const OptionDescription& one : find_method(method)->options)
        if (one.name == option && one.default_value) return std::get<double>(*one.default_value);
    return 0;
}

TEST(RobustnessLimits, WhatIsNotAskedForIsTheTablesDefault) {
    EXPECT_EQ(RobustOptions{}.Ms, limits::kDefaultMs);
    EXPECT_EQ(RobustOptions{}.Mt, limits::kDefaultMt);
    EXPECT_EQ(PeakLimits{}.Ms, limits::kDefaultMs);
    EXPECT_EQ(PeakLimits{}.Mt, limits::kDefaultMt);
    EXPECT_EQ(FrontierOptions{}.take, limits::kDefaultMs);
    EXPECT_EQ(described("robust", "Ms"), limits::kDefaultMs);
    EXPECT_EQ(described("robust", "Mt"), limits::kDefaultMt);
    EXPECT_EQ(described("frontier", "take"), limits::kDefaultMs);
    EXPECT_EQ(robust_method().overshoot({}), limits::kDefaultMaxOvershootPercent);
}

TEST(RobustnessLimits, ADesignWithoutLimitsHoldsTheDefaultAsItIsVerified) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto design = robust_method().tune({plant, *LinearPlant::make(plant), {}, {}}, {}, {});
    ASSERT_TRUE(design);
    EXPECT_EQ(design->Ms_limit, limits::kDefaultMs);
}

TEST(RobustnessLimits, TheLimitOnTheMsOfAllIsTheTablesWhereNoneIsAskedFor) {
    EXPECT_EQ(ranking_terms(EvaluateOptions{}, true).rank_Ms, limits::kDefaultMaxRankedMs);
    EvaluateOptions asked;
    asked.rank_Ms = 1.6;
    EXPECT_EQ(ranking_terms(asked, true).rank_Ms, 1.6);
}

TEST(RobustnessLimits, APeakThatIsShownAsTheLimitCountsAsHoldingIt) {
    const double held = limits::kDefaultMs * (1 + limits::kMaxRelativeExcessShown);
    EXPECT_EQ(figure_text(held), figure_text(limits::kDefaultMs));
}

}  // namespace
}  // namespace tunewright
