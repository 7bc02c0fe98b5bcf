// The servo/regulation rules beyond the published tables: scaling, warnings, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/arrieta/tradeoff.h"
#include "engine/tuning/arrieta/tradeoff_report.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

using Given = std::vector<std::pair<std::string, OptionValue>>;

Expected<TunedController> arrieta_tuned(const Plant& plant, const char* id, const Given& given) {
    MethodOptions options;
    for (const auto& [path, value] : given) options.set(path, value);
    return find_method(id)->tune({plant, *LinearPlant::make(plant), std::nullopt}, options, {});
}

Error refusal(const Plant& plant, const char* id, const Given& given) {
    const auto answer = arrieta_tuned(plant, id, given);
    return answer ? Error{ErrorKind::numerical_failure, "", "not refused"} : answer.error();
}

bool arrieta_warns(const TunedController& answer, const std::string& code) {
    return std::ranges::any_of(answer.warnings, [&](const Warning& w) { return w.code == code; });
}

double degradation_on(const Fopdt& model, const IdealPid& pid) {
    return *TradeoffScale(*LinearPlant::make(model), reference_controllers(model)).degradation(to_parallel(pid));
}

TEST(ArrietaRule, ScalesWithGainAndTimeTheExactOneToo) {
    const Given kCases[] = {{{"degradation", 0.45}}, {{"degradation", 0.4}, {"exact", true}}};
    for (const Given& given : kCases) {
        const auto unit = arrieta_tuned(Fopdt{1, 1, 0.4}, "arrieta_degradation", given);
        ASSERT_TRUE(unit);
        for (const auto& [K, time] : {std::pair{-3.0, 60.0}, {1e5, 1e-3}, {0.02, 7.0}}) {
            const auto other = arrieta_tuned(Fopdt{K, time, 0.4 * time}, "arrieta_degradation", given);
            ASSERT_TRUE(other);
            EXPECT_NEAR(other->controller.Kp * K / unit->controller.Kp, 1, 1e-7);
            EXPECT_NEAR(other->controller.Ti / time / unit->controller.Ti, 1, 1e-7);
            EXPECT_NEAR(other->controller.Td / time / unit->controller.Td, 1, 1e-7);
        }
    }
}

TEST(ArrietaRule, InBetweenTheLevelsItSolvesAndSaysSo) {
    const Fopdt model{2, 10, 3};
    const auto answer = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.4}});
    ASSERT_TRUE(answer);
    EXPECT_TRUE(arrieta_warns(*answer, "exact-degradation"));
    EXPECT_NEAR(degradation_on(model, answer->controller), 0.4, 1e-7);
    const auto asked_for = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.4}, {"exact", true}});
    EXPECT_FALSE(arrieta_warns(*asked_for, "exact-degradation"));
    EXPECT_EQ(asked_for->controller.Kp, answer->controller.Kp);
    const Error error = refusal(model, "arrieta_degradation", {{"degradation", 0.4}, {"exact", false}});
    EXPECT_EQ(error.where, "degradation");
    EXPECT_THAT(error.message, HasSubstr("0, 0.25, 0.35, 0.45, 0.55"));
}

TEST(ArrietaRule, ExactAtALevelLeavesTheTable) {
    const Fopdt model{1, 1, 2};  // where Table 2 gives 0.28 instead of 0.35
    const auto table = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.35}});
    const auto exact = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.35}, {"exact", true}});
    EXPECT_NEAR(degradation_on(model, table->controller), 0.2927, 1e-3);
    EXPECT_NEAR(degradation_on(model, exact->controller), 0.35, 1e-7);
}

// 0 is the tuning without a limit on Ms by definition.
TEST(ArrietaRule, ExactAtZeroIsTheTuningWithoutALimit) {
    const Fopdt model{1, 1, 0.5};
    const auto exact = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.0}, {"exact", true}});
    ASSERT_TRUE(exact);
    EXPECT_EQ(exact->controller.Kp, arrieta_pid(arrieta_free(), model).Kp);
}

TEST(ArrietaRule, ADegradationOutOfReachIsRefusedWithTheRange) {
    const Fopdt model{1, 1, 0.5};
    const auto at = [&](double Ms) {
        return degradation_on(model, arrieta_pid(arrieta_equation_9(Ms, ArrietaC3::refitted), model));
    };
    for (const double asked : {0.1, 0.9}) {
        const Error error = refusal(model, "arrieta_degradation", {{"degradation", asked}, {"exact", true}});
        EXPECT_EQ(error.kind, ErrorKind::unsupported);
        EXPECT_EQ(error.where, "degradation");
        char range[100];
        std::snprintf(range, sizeof range, "%.4g (Ms = 2) to %.4g (Ms = 1.4)", at(2), at(1.4));
        EXPECT_THAT(error.message, HasSubstr(range));
    }
    // At L/T = 2 an Ms of 2 is better than the tuning without a limit, so small degradations are reached.
    EXPECT_TRUE(arrieta_tuned(Fopdt{1, 1, 2}, "arrieta_degradation", {{"degradation", 0.1}, {"exact", true}}));
}

TEST(ArrietaRule, TheSmallestMsWithTheDegradationIsTaken) {
    for (const double tau : {0.1, 0.5, 1.0, 2.0}) {
        const Fopdt model{1, 1, tau};
        const auto answer = arrieta_tuned(model, "arrieta_degradation", {{"degradation", 0.4}, {"exact", true}});
        ASSERT_TRUE(answer);
        const double Ms = *answer->report_as<TradeoffReport>()->rule->Ms_design;
        for (int i = 0; i < 40; ++i) {
            const double smaller = 1.4 + (Ms - 1e-4 - 1.4) * i / 39;
            EXPECT_GT(degradation_on(model, arrieta_pid(arrieta_equation_9(smaller, ArrietaC3::refitted), model)), 0.4);
        }
    }
}

// Eq. 9 is a least-squares quadratic through four columns: the difference at a column is its residual, not a jump.
TEST(ArrietaRule, SettingsDoNotJumpAtTheLevelsOfMs) {
    for (const ArrietaLevel& column : arrieta_Ms_levels())
        for (const double tau : {0.1, 0.15, 0.3, 0.7, 1.2, 2.0})
            for (const double beside : {-1e-6, 1e-6}) {
                const double Ms = column.level + beside;
                if (Ms < kArrietaLowestMs || Ms > kArrietaHighestMs) continue;
                const auto at = arrieta_tuned(Fopdt{2, 5, 5 * tau}, "arrieta_ms", {{"Ms", column.level}}),
                           near = arrieta_tuned(Fopdt{2, 5, 5 * tau}, "arrieta_ms", {{"Ms", Ms}});
                ASSERT_TRUE(at && near);
                EXPECT_NEAR(near->controller.Kp / at->controller.Kp, 1, 0.007) << Ms << " " << tau;
                EXPECT_NEAR(near->controller.Ti / at->controller.Ti, 1, 0.011) << Ms << " " << tau;
                EXPECT_NEAR(near->controller.Td / at->controller.Td, 1, 0.033) << Ms << " " << tau;
            }
}

TEST(ArrietaRule, ThePrintedC3IsTakenWhereItIsAskedFor) {
    const Fopdt model{1, 1, 0.1};
    const Given printed = {{"Ms", 1.99}, {"c3", std::string("printed")}};
    const Given refitted = {{"Ms", 1.99}, {"c3", std::string("refitted")}};
    const auto as_printed = arrieta_tuned(model, "arrieta_ms", printed);
    ASSERT_TRUE(as_printed);
    // Td/T = a3 tau^b3 + c3, Eq. 9 by hand at M = 1.99, tau = 0.1.
    const double a3 = 0.1875 * 1.99 * 1.99 - 0.7735 * 1.99 + 1.0740;
    const double b3 = 1.3870 * 1.99 * 1.99 - 4.7810 * 1.99 + 4.9470;
    const double power = a3 * std::pow(0.1, b3);
    EXPECT_NEAR(as_printed->controller.Td, power + 0.1331 * 1.99 * 1.99 - 0.4733 * 1.99 + 0.4032, 1e-12);
    EXPECT_THAT(as_printed->report_as<TradeoffReport>()->rule->constants, HasSubstr("c3 as printed"));
    const auto by_default = arrieta_tuned(model, "arrieta_ms", {{"Ms", 1.99}});
    EXPECT_NEAR(by_default->controller.Td, power + 0.1331 * 1.99 * 1.99 - 0.4320 * 1.99 + 0.3330, 1e-12);
    EXPECT_EQ(by_default->controller.Td, arrieta_tuned(model, "arrieta_ms", refitted)->controller.Td);
    EXPECT_THAT(by_default->report_as<TradeoffReport>()->rule->constants,
                HasSubstr("c3 = 0.1331 M^2 - 0.4320 M + 0.3330"));
}

// Over the whole range, also between the levels: Ms on the model is the requested one within 2.5 %.
TEST(ArrietaRule, MsOnTheModelIsTheOneAskedFor) {
    for (int i = 0; i <= 24; ++i)
        for (const double tau : {0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0}) {
            const double Ms = 1.4 + 0.025 * i;
            const auto answer = arrieta_tuned(Fopdt{1, 1, tau}, "arrieta_ms", {{"Ms", Ms}});
            ASSERT_TRUE(answer);
            const LinearPlant model = *LinearPlant::make(Fopdt{1, 1, tau});
            const auto loop = Loop::make(model, to_parallel(answer->controller));
            EXPECT_NEAR(find_peaks(*loop, make_peak_grid(*loop)).S.value / Ms, 1, 0.025) << Ms << " " << tau;
        }
}

TEST(ArrietaRule, WarnsOutsideItsRange) {
    for (const char* id : {"arrieta_ms", "arrieta_degradation"}) {
        EXPECT_TRUE(arrieta_warns(*arrieta_tuned(Fopdt{1, 1, 0.09}, id, {}), "outside-validity")) << id;
        EXPECT_TRUE(arrieta_warns(*arrieta_tuned(Fopdt{1, 1, 2.1}, id, {}), "outside-validity")) << id;
        EXPECT_FALSE(arrieta_warns(*arrieta_tuned(Fopdt{1, 1, 0.1}, id, {}), "outside-validity")) << id;
        EXPECT_FALSE(arrieta_warns(*arrieta_tuned(Fopdt{1, 1, 2}, id, {}), "outside-validity")) << id;
    }
}

TEST(ArrietaRule, RefusesInWordsWhatItHasNoSettingsFor) {
    struct Case {
        Plant plant;
        Given given;
        const char* words;
    };
    const Case kCases[] = {
        {Fopdt{1, 1, 0}, {}, "needs a dead time"},
        {Fopdt{1, 0, 1}, {}, "pure dead time"},
        {Ipdt{1, 1}, {}, "the plant integrates"},
        {Fopdt{1, -5, 1}, {}, "unstable (a pole at 0.2)"},
        {Fopdt{1, 1, 0.02}, {{"Ms", std::string("free")}}, "gives Kp"},
        {Fopdt{1, 1, 0.5}, {{"Ms", 1.3}}, "1.4 to 2 and for \"free\""},
        {Fopdt{1, 1, 0.5}, {{"Ms", 2.1}}, "1.4 to 2 and for \"free\""},
    };
    for (const auto& [plant, given, words] : kCases)
        EXPECT_THAT(refusal(plant, "arrieta_ms", given).message, HasSubstr(words));
    EXPECT_THAT(refusal(Fopdt{1, 1, 0.03}, "arrieta_degradation", {{"degradation", 0.4}}).message,
                HasSubstr("the degradation has no reference"));
}

TEST(ArrietaRule, ASearchStopsWhenAsked) {
    MethodOptions options;
    options.set("degradation", 0.4);
    std::stop_source source;
    source.request_stop();
    const Plant plant = Fopdt{1, 1, 0.5};
    const auto answer =
        find_method("arrieta_degradation")
            ->tune({plant, *LinearPlant::make(plant), std::nullopt}, options, {source.get_token(), {}, {}});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace tunewright
