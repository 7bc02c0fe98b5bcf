// The defaults and tolerances of one table: whoever names none has the same.
#include "engine/tuning/limits.h"

#include <gtest/gtest.h>

#include "engine/number_text.h"
#include "engine/tuning/built/built_loop.h"
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

TEST(Limits, WhatIsNotAskedForIsTheTablesDefault) {
    EXPECT_EQ(RobustOptions{}.Ms, limits::kDefaultMs);
    EXPECT_EQ(RobustOptions{}.Mt, limits::kDefaultMt);
    EXPECT_EQ(robust::Limits{}.Ms, limits::kDefaultMs);
    EXPECT_EQ(robust::Limits{}.Mt, limits::kDefaultMt);
    EXPECT_EQ(built::Limits{}.Ms, limits::kDefaultMs);
    EXPECT_EQ(built::Limits{}.Mt, limits::kDefaultMt);
    EXPECT_EQ(FrontierOptions{}.take, limits::kDefaultMs);
    EXPECT_EQ(described("robust", "Ms"), limits::kDefaultMs);
    EXPECT_EQ(described("robust", "Mt"), limits::kDefaultMt);
    EXPECT_EQ(described("frontier", "take"), limits::kDefaultMs);
    EXPECT_EQ(robust_method().overshoot({}), limits::kDefaultMaxOvershootPercent);
}

TEST(Limits, ADesignWithoutLimitsHoldsTheDefaultAsItIsVerified) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto design = robust_method().tune({plant, *LinearPlant::make(plant), {}, {}}, {}, {});
    ASSERT_TRUE(design);
    EXPECT_EQ(design->Ms_limit, limits::kDefaultMs);
}

TEST(Limits, APeakThatIsShownAsTheLimitCountsAsHoldingIt) {
    const double held = limits::kDefaultMs * (1 + limits::kMaxRelativeExcessShown);
    EXPECT_EQ(figure_text(held), figure_text(limits::kDefaultMs));
}

}  // namespace
}  // namespace tunewright
