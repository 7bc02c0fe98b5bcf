// Settings from Ku and Pu alone.
#include "engine/request/ultimate_alone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace tunewright {
namespace {

using ::testing::HasSubstr;

TuningRequest known_point(std::vector<MethodRequest> methods, std::optional<double> K = {}) {
    TuningRequest request;
    request.ultimate = UltimateTest{0.903, 30.5, K};
    request.tune = std::move(methods);
    return request;
}

const IdealPid& settings_of(const TuningEntry& entry) { return std::get<IdealPid>(*entry.unjudged); }

TEST(UltimateAlone, RulesGiveTheirPublishedSettingsAndNoFigureOfTheLoop) {
    const auto result = tune(known_point({{"ziegler_nichols_ultimate", {}}, {"tyreus_luyben", {}}}), {});
    ASSERT_TRUE(result) << result.error().message;
    const IdealPid& zn = settings_of(result->controllers[0]);
    EXPECT_NEAR(zn.Kp, 0.6 * 0.903, 1e-12);
    EXPECT_NEAR(zn.Ti, 30.5 / 2, 1e-12);
    EXPECT_NEAR(zn.Td, 30.5 / 8, 1e-12);
    const IdealPid& tl = settings_of(result->controllers[1]);
    EXPECT_NEAR(tl.Kp, 0.903 / 2.2, 1e-12);
    EXPECT_NEAR(tl.Ti, 2.2 * 30.5, 1e-12);
    EXPECT_NEAR(tl.Td, 30.5 / 6.3, 1e-12);
    for (const TuningEntry& entry : result->controllers) {
        EXPECT_FALSE(entry.evaluation);
        EXPECT_EQ(entry.verdict.front().code, "robustness-unknown");
    }
    EXPECT_EQ(result->ranking.size(), 2u);
}

TEST(UltimateAlone, AmigoNeedsTheStaticGainToo) {
    const auto without = tune(known_point({{"amigo_ultimate", {}}}), {});
    ASSERT_FALSE(without);
    EXPECT_THAT(without.error().message, HasSubstr("static gain"));
    const auto with_gain = tune(known_point({{"amigo_ultimate", {}}}, 4.0), {});
    ASSERT_TRUE(with_gain) << with_gain.error().message;
    // Åström and Hägglund (2004), kappa = 1/(K Ku).
    const double kappa = 1 / (4 * 0.903);
    EXPECT_NEAR(settings_of(with_gain->controllers[0]).Kp, (0.3 - 0.1 * std::pow(kappa, 4)) * 0.903, 1e-12);
    EXPECT_NEAR(settings_of(with_gain->controllers[0]).Ti, 0.6 * 30.5 / (1 + 2 * kappa), 1e-12);
}

TEST(UltimateAlone, AllAreTheRulesOnTheUltimatePointAndOthersSayWhatTheyNeed) {
    const auto all = tune(known_point({{"all", {}}}), {});
    ASSERT_TRUE(all);
    EXPECT_GE(all->ranking.size(), 5u);
    const auto robust = tune(known_point({{"robust", {}}, {"tyreus_luyben", {}}}), {});
    ASSERT_TRUE(robust);
    ASSERT_TRUE(robust->controllers[0].error);
    EXPECT_THAT(robust->controllers[0].error->message, HasSubstr("needs a model"));
    EXPECT_EQ(robust->ranking, std::vector<int>{1});
}

/// The same words as for every other entry without a controller (docs/verdicts.md).
TEST(UltimateAlone, AMethodWithoutAnAnswerHasTheVerdictOfEveryOther) {
    const auto result = tune(known_point({{"robust", {}}, {"tyreus_luyben", {}}}), {});
    ASSERT_TRUE(result);
    const auto& verdict = result->controllers[0].verdict;
    ASSERT_EQ(verdict.size(), 2u);
    EXPECT_EQ(verdict[0].code, "no-controller");
    EXPECT_EQ(verdict[0].level, verdict::Level::bad);
    EXPECT_EQ(verdict[1].code, "reason");
    EXPECT_EQ(verdict[1].text, result->controllers[0].error->message);
    EXPECT_NE(verdict[0].text, verdict[1].text);
}

TEST(UltimateAlone, KuHasTheSignOfTheStaticGain) {
    for (const auto& [Ku, K] : {std::pair{-2.0, 1.0}, {2.0, -1.0}}) {
        TuningRequest request = known_point({{"all", {}}}, K);
        request.ultimate->Ku = Ku;
        const auto result = tune(request, {});
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().kind, ErrorKind::invalid_argument);
        EXPECT_EQ(result.error().where, "ultimate/Ku");
        EXPECT_THAT(result.error().message, HasSubstr("same sign"));
    }
    TuningRequest both = known_point({{"tyreus_luyben", {}}}, -4);
    both.ultimate->Ku = -0.903;
    EXPECT_TRUE(tune(both, {}));
}

}  // namespace
}  // namespace tunewright
