#include "engine/tuning/npid/npid_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/evaluation/evaluate.h"
#include "engine/loop/stability.h"
#include "engine/request/tune.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

MethodOptions with(const std::vector<std::pair<const char*, OptionValue>>& given) {
    MethodOptions options;
    for (const auto& [name, value] : given) options.set(name, value);
    return options;
}

const MethodOptions kOptimise = with({{"optimise", true}});

Expected<TunedController> npid_tuned(const char* id, const Plant& plant, const MethodOptions& options = {},
                                     const RunControl& control = {}) {
    return find_method(id)->tune(TuningProblem{plant, *LinearPlant::make(plant), std::nullopt}, options, control);
}

SetpointPerformance setpoint_of(const Plant& plant, const TunedController& answer, double step = 1) {
    EvaluateOptions options;
    options.points = 0;
    options.setpoint_step = step;
    const auto evaluation = evaluate(PlantModel(plant), controller_of(answer), options);
    EXPECT_TRUE(evaluation.has_value() && evaluation->robustness.stable);
    return evaluation->performance.setpoint;
}

bool warns_with(const TunedController& answer, const std::string& code, const std::string& part) {
    return std::ranges::any_of(answer.warnings, [&](const Warning& warning) {
        return warning.code == code && warning.detail.find(part) != std::string::npos;
    });
}

TEST(NpidRule, SaysWhichTableAndWhereItWasNotFitted) {
    EXPECT_TRUE(npid_tuned("npid_iae", Fopdt{.K = 1, .T = 1, .L = 0.9})->warnings.empty());
    const auto gap = npid_tuned("npid_iae", Fopdt{.K = 1, .T = 1, .L = 0.95});
    EXPECT_TRUE(warns_with(*gap, "rule-table", "Between 0.9 and 1"));
    EXPECT_FALSE(warns_with(*gap, "outside-validity", ""));
    EXPECT_TRUE(warns_with(*npid_tuned("npid_ise", Fopdt{.K = 1, .T = 1, .L = 2}), "rule-table", "long dead times"));
    EXPECT_TRUE(warns_with(*npid_tuned("npid_ise", Fopdt{.K = 1, .T = 1, .L = 3.1}), "outside-validity", "L/T is 3.1"));
    EXPECT_TRUE(warns_with(*npid_tuned("npid_itae", Fopdt{.K = 1, .T = 1, .L = 0.009}), "outside-validity", "0.009"));
}

TEST(NpidRule, RefusesWhatItsFormulaCannotTake) {
    const auto message = [](const Plant& plant, const MethodOptions& options = {}) {
        const auto answer = npid_tuned("npid_ise", plant, options);
        EXPECT_FALSE(answer.has_value());
        return answer ? std::string() : answer.error().message;
    };
    EXPECT_THAT(message(Fopdt{.K = 1, .T = 1, .L = 0}), testing::HasSubstr("dead time of the model is 0"));
    EXPECT_THAT(message(Fopdt{.K = 1, .T = 0, .L = 1}), testing::HasSubstr("pure dead time"));
    EXPECT_THAT(message(Ipdt{.K = 1, .L = 1}), testing::HasSubstr("optimise"));
    EXPECT_FALSE(message(Fopdt{.K = 1, .T = -5, .L = 1}).empty());
    EXPECT_THAT(message(Fopdt{.K = 1, .T = 1, .L = 0}, kOptimise),
                testing::HasSubstr("a higher gain always gives a smaller error"));
    EXPECT_EQ(npid_tuned("npid_ise", Fopdt{.K = 1, .T = 1, .L = 0}, kOptimise).error().kind,
              ErrorKind::unbounded_optimum);
}

TEST(NpidRule, ScalesWithGainAndTime) {
    for (const auto& options : {MethodOptions{}, kOptimise}) {
        const auto base = npid_tuned("npid_itae", Fopdt{.K = 1, .T = 1, .L = 0.4}, options)->controller;
        const auto scaled = npid_tuned("npid_itae", Fopdt{.K = -20, .T = 1000, .L = 400}, options)->controller;
        EXPECT_NEAR(scaled.Kp * -20 / base.Kp, 1, 1e-3);
        EXPECT_NEAR(scaled.Ti / 1000 / base.Ti, 1, 1e-3);
        EXPECT_NEAR(scaled.Td / 1000 / base.Td, 1, 1e-3);
    }
}

TEST(NpidRule, WorksOnTheModelOfLeastAbsoluteDifference) {
    // Jin and Son reduce with a genetic algorithm to K 1, T 10.002, L 3.06; the smallest IAE is at 1.000, 10.006,
    // 3.043.
    const auto answer = npid_tuned("npid_ise", Sopdt{.K = 1, .T1 = 10, .T2 = 1, .L = 2});
    ASSERT_TRUE(answer->reduced_model.has_value());
    const auto& model = std::get<Fopdt>(*answer->reduced_model);
    EXPECT_NEAR(model.T, 10.002, 0.011 * 10);
    EXPECT_NEAR(model.L, 3.06, 0.011 * 3.06);
    EXPECT_NEAR(answer->controller.Kp, 3.823, 0.02 * 3.823);
}

TEST(NpidRule, TheFilterIsOfTheDerivativeAndOptional) {
    const Fopdt plant{.K = 1, .T = 1, .L = 0.5};
    EXPECT_EQ(npid_tuned("npid_ise", plant)->controller.filter.type, FilterType::none);
    const auto filtered = npid_tuned("npid_ise", plant, with({{"filter/Tf_over_Td", 0.1}}))->controller;
    EXPECT_EQ(filtered.filter.type, FilterType::derivative);
    EXPECT_NEAR(filtered.filter.Tf, 0.1 * filtered.Td, 1e-15);
    EXPECT_EQ(npid_tuned("npid_ise", plant, with({{"filter/Tf", 0.02}}))->controller.filter.Tf, 0.02);
}

TEST(NpidOptimise, IsNeverWorseThanTheRuleOnItsOwnCriterion) {
    const Plant plants[] = {Sopdt{.K = 2, .T1 = 10, .T2 = 8, .L = 1},
                            OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.5, .L = 0.5},
                            Zpk{.K = -1, .zeros = {1.0}, .poles = {-1.0, -1.0, -1.0}, .L = 0.2}};
    for (const Plant& plant : plants) {
        const auto rule = npid_tuned("npid_iae", plant), optimum = npid_tuned("npid_iae", plant, kOptimise);
        ASSERT_TRUE(optimum.has_value()) << optimum.error().message;
        EXPECT_FALSE(optimum->reduced_model.has_value());
        const auto best = *setpoint_of(plant, *optimum).IAE;
        if (rule) {
            EvaluateOptions options;
            options.points = 0;
            const auto by_rule = evaluate(PlantModel(plant), controller_of(*rule), options);
            if (by_rule && by_rule->robustness.stable) {
                EXPECT_LE(best, *by_rule->performance.setpoint.IAE * 1.0001);
            }
        }
        // The cost is not higher than that of neighbouring settings either.
        for (const double factor : {0.97, 1.03}) {
            for (double IdealPid::*parameter : {&IdealPid::Kp, &IdealPid::Ti, &IdealPid::Td}) {
                TunedController neighbour = *optimum;
                neighbour.controller.*parameter *= factor;
                const auto loop = *LinearPlant::make(plant);
                if (!count_unstable_poles(*Loop::make(loop, to_parallel(neighbour.controller))).stable()) continue;
                EXPECT_GE(*setpoint_of(plant, neighbour).IAE, best * 0.9999);
            }
        }
    }
}

TEST(NpidOptimise, ServesPlantsThatTheRuleDoesNot) {
    for (const Plant& plant : {Plant(Ipdt{.K = 0.5, .L = 1}), Plant(Ipdt{.K = 0.5, .L = 1, .T = 2}),
                               Plant(Fopdt{.K = 1, .T = -5, .L = 1}), Plant(Fopdt{.K = 1, .T = 0, .L = 1}),
                               Plant(Zpk{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0, -1.0}, .L = 0})}) {
        const auto optimum = npid_tuned("npid_iae", plant, kOptimise);
        ASSERT_TRUE(optimum.has_value()) << optimum.error().message;
        EXPECT_TRUE(setpoint_of(plant, *optimum).IAE.has_value());
    }
}

TEST(NpidOptimise, GivesTheSameAnswerTwice) {
    const Fopdt plant{.K = 1, .T = 1, .L = 0.37};
    const auto a = npid_tuned("npid_itae", plant, kOptimise)->controller,
               b = npid_tuned("npid_itae", plant, kOptimise)->controller;
    EXPECT_EQ(a.Kp, b.Kp);
    EXPECT_EQ(a.Ti, b.Ti);
    EXPECT_EQ(a.Td, b.Td);
}

TEST(NpidOptimise, StopsWhenAskedAndReportsOnTheWay) {
    std::stop_source source;
    double last = 0;
    RunControl control;
    control.stop = source.get_token();
    control.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last);
        EXPECT_LE(progress.fraction, 1);
        last = progress.fraction;
        if (last > 0.3) source.request_stop();
    };
    const Fopdt plant{.K = 1, .T = 1, .L = 0.5};
    const auto answer = npid_tuned("npid_iae", plant, kOptimise, control);
    ASSERT_TRUE(answer.has_value());
    EXPECT_TRUE(answer->partial);
    EXPECT_LT(last, 0.4);
    EXPECT_TRUE(setpoint_of(plant, *answer).IAE.has_value());
    std::stop_source at_once;
    at_once.request_stop();
    control = {.stop = at_once.get_token(), .progress = {}, .now_ms = {}};
    EXPECT_EQ(npid_tuned("npid_iae", plant, kOptimise, control).error().kind, ErrorKind::cancelled);
}

TEST(NpidOptimise, HoldsForEveryStepSizeBecauseDeltaFollowsIt) {
    const Fopdt plant{.K = 1, .T = 1, .L = 0.5};
    const auto answer = *npid_tuned("npid_ise", plant);
    EXPECT_NEAR(*setpoint_of(plant, answer, 5).IAE / 5, *setpoint_of(plant, answer, 1).IAE, 1e-6);
}

}  // namespace
}  // namespace tunewright
