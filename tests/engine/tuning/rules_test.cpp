// The closed-form rules: published settings, refusals, and properties common to every rule for a first-order model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "tests/engine/tuning/reference_batch.h"
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

using test::expect_settings;
using test::Given;
using test::kPI;
using test::tuned;
using test::warns;

const std::vector<std::string> kRules{"amigo", "simc", "lambda", "ziegler_nichols_step"};

TEST(Registry, FindsEveryMethodByItsIdAndNothingElse) {
    for (const auto& method : method_registry()) {
        EXPECT_EQ(find_method(method.id), &method);
        EXPECT_FALSE(method.title.empty() || method.formula.empty() || method.source.empty() || method.needs.empty() ||
                     method.validity.empty())
            << method.id;
        EXPECT_NE(method.tune, nullptr);
        for (const auto& option : method.options)
            EXPECT_FALSE(option.name.empty() || option.sentence.empty()) << method.id;
    }
    EXPECT_EQ(find_method("none-of-ours"), nullptr);
}

TEST(Amigo, AgreesWithTheReferenceSettingsOnEveryPlantOfTheBatch) {
    for (const auto& row : test::reference_rows()) {
        SCOPED_TRACE(row.at("id").get<std::string>());
        const Zpk plant = test::plant_of(row);
        const auto& pid = row.at("amigo_pid");
        const auto answer = tuned("amigo", plant);
        expect_settings(answer, pid.at("K"), pid.at("Ti"), pid.at("Td"), 2e-5);
        EXPECT_EQ(answer->controller.filter.type, FilterType::measurement_second_order);
        EXPECT_NEAR(answer->controller.filter.Tf, pid.at("Tf").get<double>(), 2e-5 * pid.at("Tf").get<double>());
        EXPECT_TRUE(answer->reduced_model);

        const auto& pi = row.at("amigo_pi");
        const auto pi_answer = tuned("amigo", plant, kPI);
        expect_settings(pi_answer, pi.at("K"), pi.at("Ti"), 0, 2e-5);
        EXPECT_EQ(pi_answer->controller.filter.type, FilterType::none);
    }
}

TEST(Amigo, PureDeadTimeIsWithinItsRange) {
    expect_settings(tuned("amigo", Fopdt{.K = 2, .T = 0, .L = 3}), 0.1, 1.2, 0);
    expect_settings(tuned("amigo", Fopdt{.K = 2, .T = 0, .L = 3}, kPI), 0.075, 1.05, 0);
}

TEST(Amigo, SetPointWeightFollowsTheNormalisedDeadTime) {
    EXPECT_EQ(tuned("amigo", Fopdt{.K = 1, .T = 1.01, .L = 1})->controller.b, 0);
    EXPECT_EQ(tuned("amigo", Fopdt{.K = 1, .T = 0.99, .L = 1})->controller.b, 1);
    EXPECT_EQ(tuned("amigo", Fopdt{.K = 1, .T = 1.01, .L = 1}, kPI)->controller.b, 1);
}

TEST(Amigo, WarnsOfConservativeSettingsWithLittleDeadTime) {
    EXPECT_TRUE(warns(*tuned("amigo", Fopdt{.K = 1, .T = 10, .L = 1}), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("amigo", Fopdt{.K = 1, .T = 2, .L = 1}), "outside-validity"));
}

// Skogestad (2003), Example 2 and Table 1.
TEST(Simc, ReproducesThePublishedSettings) {
    const double lags = 2 * 1 * 0.4 * 0.2 * 0.05 * 0.05 * 0.05;
    const Zpk plant{
        .K = -0.3 * 0.08 / lags, .zeros = {1 / 0.3, -1 / 0.08}, .poles = {-0.5, -1.0, -2.5, -5.0, -20.0, -20.0, -20.0}};
    expect_settings(tuned("simc", plant, kPI), 2.5 / (2 * 1.47), 2.5, 0);
    // Series 1.30, 2, 1.2 (printed digits), ideal without filter: Kp (1 + Td/Ti), Ti + Td, Ti Td/(Ti + Td).
    const auto pid = tuned("simc", plant, {{"filter/Tf_over_Td", 0.0}});
    expect_settings(pid, 2 / (2 * 0.77) * (1 + 1.2 / 2), 3.2, 2 * 1.2 / 3.2);
    EXPECT_EQ(pid->controller.filter.type, FilterType::none);
    ASSERT_TRUE(pid->reduced_model);
    EXPECT_NEAR(std::get<Sopdt>(*pid->reduced_model).L, 0.77, 1e-9);
}

TEST(Simc, CoversTheIntegratingAndTheDoubleLagPlants) {
    expect_settings(tuned("simc", Ipdt{.K = 0.5, .L = 2}, kPI), 1 / (0.5 * 4), 16, 0);
    const Given unfiltered{{"filter/Tf_over_Td", 0.0}};
    // Integrating with lag 3: series 0.5, 16, 3.
    expect_settings(tuned("simc", Ipdt{.K = 0.5, .L = 2, .T = 3}, unfiltered), 0.5 * (1 + 3.0 / 16), 19, 16 * 3.0 / 19);
    // Two equal lags 10: series 10/(2 K) , min(10, 8), 10.
    expect_settings(tuned("simc", Sopdt{.K = 1, .T1 = 10, .T2 = 10, .L = 1}, unfiltered), 5 * (1 + 10.0 / 8), 18,
                    80.0 / 18);
    // Double integrator: series 1/(4 K 4), 8, 8.
    expect_settings(tuned("simc", TransferFunction{.num = {0.5}, .den = {1, 0, 0}, .L = 1}, unfiltered), 1 / 8.0 * 2,
                    16, 4);
}

TEST(Simc, SeriesFormIsAnsweredExactlyWithAFilterThatStaysFasterThanTheLoop) {
    // Two lags far above the dead time: series 50, 8, 100.
    const auto answer = tuned("simc", Sopdt{.K = 1, .T1 = 100, .T2 = 100, .L = 1});
    expect_settings(answer, 50 * 108 / 8.0, 108, 800 / 108.0);
    const IdealPid& pid = answer->controller;
    EXPECT_EQ(pid.filter.type, FilterType::derivative);
    EXPECT_NEAR(pid.filter.Tf, 0.1 * pid.Td, 1e-15);
    const auto series = to_series(IdealPid{.Kp = pid.Kp, .Ti = pid.Ti, .Td = pid.Td});
    ASSERT_TRUE(series);
    // The larger root is called Ti: here the lag 100; Kp/Ti is unchanged.
    EXPECT_NEAR(series->Ti, 100, 1e-9);
    EXPECT_NEAR(series->Kp / series->Ti, 50 / 8.0, 1e-9);
}

TEST(Simc, TauCSlowsTheLoopAndBelowTheDeadTimeItWarns) {
    const Fopdt plant{.K = 2, .T = 10, .L = 1};
    auto given = kPI;
    given.push_back({"tau_c", 4.0});
    expect_settings(tuned("simc", plant, given), 1, 10, 0);
    EXPECT_TRUE(tuned("simc", plant, given)->warnings.empty());
    given.back().second = 0.5;
    EXPECT_TRUE(warns(*tuned("simc", plant, given), "outside-validity"));
}

TEST(Simc, FirstOrderModelGetsPiAndTheAnswerSaysSo) {
    const auto answer = tuned("simc", Fopdt{.K = 2, .T = 10, .L = 1});
    expect_settings(answer, 2.5, 8, 0);
    EXPECT_TRUE(warns(*answer, "no-derivative"));
    EXPECT_FALSE(answer->reduced_model);
}

TEST(Simc, SmallSecondLagIsOutsideTheRecommendation) {
    EXPECT_TRUE(warns(*tuned("simc", Sopdt{.K = 1, .T1 = 10, .T2 = 1, .L = 2}), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("simc", Sopdt{.K = 1, .T1 = 10, .T2 = 3, .L = 2}), "outside-validity"));
}

// Ziegler and Nichols (1942), with the reaction rate R = K/T = 0.2 and lag 2: 1/(R L) = 2.5.
TEST(ZieglerNicholsStep, ReproducesTheOriginalTable) {
    const Fopdt plant{.K = 2, .T = 10, .L = 2};
    const auto infinity = std::numeric_limits<double>::infinity();
    expect_settings(tuned("ziegler_nichols_step", plant, {{"controller", std::string("P")}}), 2.5, infinity, 0);
    expect_settings(tuned("ziegler_nichols_step", plant, kPI), 2.25, 2 / 0.3, 0);
    const auto pid = tuned("ziegler_nichols_step", plant);
    expect_settings(pid, 3, 4, 1);
    EXPECT_EQ(pid->controller.filter.type, FilterType::derivative);
    EXPECT_NEAR(pid->controller.filter.Tf, 0.1, 1e-15);
    expect_settings(tuned("ziegler_nichols_step", Ipdt{.K = 0.2, .L = 2}), 3, 4, 1);
}

TEST(ZieglerNicholsStep, UsesTheSteepestSlopeNotTheSixtyThreePercentTime) {
    // 1/(s + 1)^2: slope 1/e, foot 3 - e.
    const double e = std::exp(1.0), L = 3 - e;
    expect_settings(tuned("ziegler_nichols_step", Sopdt{.K = 1, .T1 = 1, .T2 = 1}), 1.2 * e / L, 2 * L, L / 2, 1e-7);
}

TEST(ZieglerNicholsStep, WarnsOutsideItsUsualRange) {
    EXPECT_TRUE(warns(*tuned("ziegler_nichols_step", Fopdt{.K = 1, .T = 100, .L = 1}), "outside-validity"));
    EXPECT_TRUE(warns(*tuned("ziegler_nichols_step", Fopdt{.K = 1, .T = 1, .L = 2}), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("ziegler_nichols_step", Fopdt{.K = 1, .T = 2, .L = 1}), "outside-validity"));
}

TEST(Lambda, FollowsItsFormulas) {
    const Fopdt plant{.K = 2, .T = 10, .L = 2};
    auto given = kPI;
    given.push_back({"lambda", 3.0});
    expect_settings(tuned("lambda", plant, given), 10 / (2 * 5.0), 10, 0);
    expect_settings(tuned("lambda", plant, {{"lambda", 3.0}}), 22 / (2 * 8.0), 11, 20 / 22.0);
    // Default: max(T, L).
    expect_settings(tuned("lambda", plant, kPI), 10 / (2 * 12.0), 10, 0);
    expect_settings(tuned("lambda", Ipdt{.K = 0.5, .L = 2}, given), 8 / (0.5 * 25), 8, 0);
    expect_settings(tuned("lambda", Ipdt{.K = 0.5, .L = 2}, {{"lambda", 3.0}}), 8 / (0.5 * 16), 8, 7 / 8.0);
}

TEST(Lambda, WorksWithoutDeadTime) {
    expect_settings(tuned("lambda", Fopdt{.K = 2, .T = 10, .L = 0}), 0.5, 10, 0);
    expect_settings(tuned("lambda", Ipdt{.K = 2, .L = 0}, {{"lambda", 3.0}}), 1 / 3.0, 6, 0);
}

TEST(Lambda, WarnsBelowTheRecommendedLambda) {
    const Fopdt plant{.K = 1, .T = 2, .L = 1};
    EXPECT_TRUE(warns(*tuned("lambda", plant, {{"lambda", 0.5}}), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("lambda", plant), "outside-validity"));
}

// The rows for a method in "all".
std::vector<MethodOptions> rows_of(const TuningMethod& method) {
    std::vector<MethodOptions> rows;
    for (const auto& variant : method.variants) rows.push_back(variant.options);
    const auto controller = std::ranges::find(method.options, "controller", &OptionDescription::name);
    if (rows.empty() && controller != method.options.end())
        for (const auto& choice : controller->choices) rows.push_back(test::options_of({{"controller", choice}}));
    if (rows.empty()) rows.emplace_back();
    return rows;
}

TEST(Rules, ScalingTimeAndGainScalesTheSettingsOfEveryRow) {
    const auto scales = [](const TuningMethod& method, const Plant& plant, const Plant& larger) {
        for (const auto& options : rows_of(method)) {
            SCOPED_TRACE(method.id);
            const auto base = method.tune({plant, *LinearPlant::make(plant), std::nullopt}, options, {});
            const auto scaled = method.tune({larger, *LinearPlant::make(larger), std::nullopt}, options, {});
            ASSERT_EQ(base.has_value(), scaled.has_value());
            if (!base) continue;
            const IdealPid &a = base->controller, &b = scaled->controller;
            expect_settings(scaled, a.Kp / -4, a.Ti * 100, a.Td * 100, 1e-6);
            EXPECT_NEAR(b.filter.Tf, 100 * a.filter.Tf, 1e-4 * a.filter.Tf);
            EXPECT_NEAR(a.b, b.b, 1e-9);
            EXPECT_EQ(base->warnings.size(), scaled->warnings.size());
        }
    };
    for (const auto& method : method_registry()) {
        if (method.id == "robust" || method.id == "emulation") continue;  // searches, tested separately
        scales(method, Sopdt{.K = 1.5, .T1 = 4, .T2 = 3, .L = 1}, Sopdt{.K = -6, .T1 = 400, .T2 = 300, .L = 100});
        scales(method, Fopdt{.K = 1.5, .T = 4, .L = 3}, Fopdt{.K = -6, .T = 400, .L = 300});
        scales(method, Ipdt{.K = 1.5, .L = 3}, Ipdt{.K = -0.06, .L = 300});
    }
}

TEST(Rules, DegenerateModelsAreRefusedWithACureNotDivided) {
    const auto refusal = [](const std::string& id, const Plant& plant) {
        const auto answer = tuned(id, plant);
        if (answer) return std::string("tuned");
        EXPECT_EQ(answer.error().kind, ErrorKind::unsupported) << id;
        return answer.error().where + ": " + answer.error().message;
    };
    const Fopdt no_dead_time{.K = 1, .T = 5, .L = 0}, no_lag{.K = 1, .T = 0, .L = 5};
    EXPECT_THAT(refusal("amigo", no_dead_time), HasSubstr("plant/L: AMIGO divides by the dead time"));
    EXPECT_THAT(refusal("ziegler_nichols_step", no_dead_time), HasSubstr("or robust with a fixed filter Tf"));
    EXPECT_THAT(refusal("simc", no_dead_time), HasSubstr("plant/L: SIMC divides by tau_c + L"));
    EXPECT_THAT(refusal("simc", no_lag), HasSubstr("plant/T: The model is a pure dead time (T = 0)"));
    EXPECT_THAT(refusal("lambda", no_lag), HasSubstr("Use amigo or robust."));
    EXPECT_THAT(refusal("ziegler_nichols_step", no_lag), HasSubstr("pure dead time"));
    EXPECT_THAT(refusal("lambda", Ipdt{.K = 1, .L = 0}), HasSubstr("Give lambda"));
    for (const auto& id : kRules) {
        EXPECT_THAT(refusal(id, Fopdt{.K = 1, .T = 0, .L = 0}), HasSubstr("plant/")) << id;
        EXPECT_THAT(refusal(id, Ipdt{.K = 1, .L = 0}), HasSubstr("plant/L")) << id;
        EXPECT_THAT(refusal(id, Fopdt{.K = 1, .T = -5, .L = 1}), HasSubstr("unstable")) << id;
    }
}

TEST(Rules, NumbersBeyondUseAreRefused) {
    const auto answer = tuned("amigo", Fopdt{.K = 1e-300, .T = 1e300, .L = 1e-300});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::numerical_failure);
}

TEST(Rules, FilterOptionsAreHonoured) {
    for (const auto& id : kRules) {
        const Sopdt plant{.K = 1, .T1 = 3, .T2 = 2, .L = 1};
        EXPECT_DOUBLE_EQ(tuned(id, plant, {{"filter/Tf", 0.01}})->controller.filter.Tf, 0.01);
        const auto half = tuned(id, plant, {{"filter/Tf_over_Td", 0.5}})->controller;
        EXPECT_DOUBLE_EQ(half.filter.Tf, 0.5 * half.Td);
        EXPECT_EQ(tuned(id, plant, {{"filter/Tf_over_Td", 0.0}})->controller.filter.type, FilterType::none);
    }
}

TEST(Rules, NamedReductionIsUsedAndShown) {
    const Sopdt plant{.K = 1, .T1 = 5, .T2 = 1, .L = 1};
    const auto half = tuned("amigo", plant, {{"reduction/method", std::string("half_rule")}});
    ASSERT_TRUE(half && half->reduced_model);
    EXPECT_DOUBLE_EQ(std::get<Fopdt>(*half->reduced_model).T, 5.5);
    EXPECT_DOUBLE_EQ(std::get<Fopdt>(*half->reduced_model).L, 1.5);
    EXPECT_NE(tuned("amigo", plant)->controller.Kp, half->controller.Kp);
    EXPECT_FALSE(tuned("amigo", Fopdt{.K = 1, .T = 3, .L = 1})->reduced_model);
}

}  // namespace
}  // namespace tunewright
