// Reduction to the forms of the rules: published examples of the half rule, exact tangents, refusals.
#include "engine/reduction/reduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/tuning/reference_batch.h"

namespace tunewright {
namespace {

using ::testing::HasSubstr;

LinearPlant reducible(const Plant& plant) { return *LinearPlant::make(plant); }

Expected<ReducedModel> reduced(const Plant& plant, ReductionMethod method, ReducedOrder order = ReducedOrder::first) {
    return reduce(reducible(plant), {.order = order, .method = method});
}

void expect_model(const Expected<ReducedModel>& model, int integrators, double K, double T1, double T2, double L,
                  double tolerance = 1e-9) {
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->integrators, integrators);
    EXPECT_NEAR(model->K, K, tolerance * std::abs(K));
    EXPECT_NEAR(model->T1, T1, tolerance * (T1 + 1));
    EXPECT_NEAR(model->T2, T2, tolerance * (T2 + 1));
    EXPECT_NEAR(model->L, L, tolerance * (L + 1));
}

// k (-0.3 s + 1)(0.08 s + 1)/((2 s + 1)(s + 1)(0.4 s + 1)(0.2 s + 1)(0.05 s + 1)^3) with k = 3.
Zpk skogestad_example_2() {
    const double lags = 2 * 1 * 0.4 * 0.2 * 0.05 * 0.05 * 0.05;
    return {.K = 3 * -0.3 * 0.08 / lags,
            .zeros = {1 / 0.3, -1 / 0.08},
            .poles = {-0.5, -1.0, -2.5, -5.0, -20.0, -20.0, -20.0}};
}

// Skogestad (2003), Examples 1 and 2.
TEST(HalfRule, ReproducesThePublishedExamples) {
    expect_model(reduced(Sopdt{.K = 1, .T1 = 1, .T2 = 0.2}, ReductionMethod::half_rule), 0, 1, 1.1, 0, 0.1);
    expect_model(reduced(skogestad_example_2(), ReductionMethod::half_rule), 0, 3, 2.5, 0, 1.47);
    expect_model(reduced(skogestad_example_2(), ReductionMethod::half_rule, ReducedOrder::second), 0, 3, 2, 1.2, 0.77);
}

TEST(HalfRule, FourEqualLagsKeepTheLargerConstantFirst) {
    const Zpk plant{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0, -1.0}};
    expect_model(reduced(plant, ReductionMethod::half_rule), 0, 1, 1.5, 0, 2.5);
    expect_model(reduced(plant, ReductionMethod::half_rule, ReducedOrder::second), 0, 1, 1.5, 1, 1.5);
}

// (0.17 s + 1)^2/(s (s + 1)^2 (0.028 s + 1)): Skogestad (2003), case E6 of the table of examples.
TEST(HalfRule, IntegratingPlantWithLeadsLosesThemAgainstTheClosestLag) {
    const Zpk plant{.K = 0.17 * 0.17 / 0.028, .zeros = {-1 / 0.17, -1 / 0.17}, .poles = {0.0, -1.0, -1.0, -1 / 0.028}};
    expect_model(reduced(plant, ReductionMethod::half_rule), 1, 1, 0, 0, 1.688);
    expect_model(reduced(plant, ReductionMethod::half_rule, ReducedOrder::second), 1, 1, 1.33, 0, 0.358);
}

TEST(HalfRule, LeadRulesFollowTheirCases) {
    // T1: lead 12 against the lag 10, theta 1 (no larger lag): gain 12/10.
    expect_model(reduced(TransferFunction{.num = {12, 1}, .den = {50, 15, 1}, .L = 1}, ReductionMethod::half_rule), 0,
                 1.2, 5, 0, 1);
    // T3 with the lag above 5 theta: lead 2 against 10, theta 1: 5/10 of the gain and a lag 3.
    expect_model(reduced(TransferFunction{.num = {2, 1}, .den = {10, 1}, .L = 1}, ReductionMethod::half_rule), 0, 0.5,
                 3, 0, 1);
    // T2: lead 8 >= 5 theta with lag 10: gain 0.8, nothing left of the lag.
    expect_model(reduced(TransferFunction{.num = {8, 1}, .den = {10, 1}, .L = 1}, ReductionMethod::half_rule), 0, 0.8,
                 0, 0, 1);
    // T1a: lead 3 >= theta 2 >= lag 1: gain 3/2.
    expect_model(reduced(TransferFunction{.num = {3, 1}, .den = {1, 1}, .L = 2}, ReductionMethod::half_rule), 0, 1.5, 0,
                 0, 2);
    // T1b: theta 5 >= lead 3 >= lag 1: they cancel.
    expect_model(reduced(TransferFunction{.num = {3, 1}, .den = {1, 1}, .L = 5}, ReductionMethod::half_rule), 0, 1, 0,
                 0, 5);
}

TEST(HalfRule, WellDampedPairCountsAsTwoLagsAndSaysSo) {
    const auto model = reduced(OscillatorySopdt{.K = 2, .T = 5, .zeta = 0.8, .L = 1}, ReductionMethod::half_rule,
                               ReducedOrder::second);
    expect_model(model, 0, 2, 4, 4, 1);
    ASSERT_EQ(model->warnings.size(), 1u);
    EXPECT_EQ(model->warnings[0].code, "complex-poles-as-lags");
    EXPECT_FALSE(model->exact);
}

TEST(HalfRule, RepeatedPolesGivenAsAPolynomialAreLags) {
    const auto model = reduced(TransferFunction{.num = {1}, .den = {1, 4, 6, 4, 1}}, ReductionMethod::half_rule);
    expect_model(model, 0, 1, 1.5, 0, 2.5, 1e-3);
    EXPECT_TRUE(model->warnings.empty());
}

TEST(HalfRule, RefusesWhatItCannotExpressAndNamesTheTangent) {
    const auto ringing = reduced(OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.2}, ReductionMethod::half_rule);
    ASSERT_FALSE(ringing);
    EXPECT_EQ(ringing.error().kind, ErrorKind::unsupported);
    EXPECT_EQ(ringing.error().where, "reduction/method");
    EXPECT_THAT(ringing.error().message, HasSubstr("damping 0.2 (below 0.5). Choose the reduction tangent"));
    EXPECT_FALSE(reduced(TransferFunction{.num = {1, 0.2, 1}, .den = {1, 3, 3, 1}}, ReductionMethod::half_rule));
}

// For 1/(T s + 1)^2: slope 1/(e T) at t = T, y(T) = 1 - 2/e, so the foot lies at T (3 - e) and K/slope is e T.
TEST(Tangent, TwoEqualLagsHaveTheTextbookTangent) {
    const auto model = reduced(Sopdt{.K = -3, .T1 = 7, .T2 = 7, .L = 2}, ReductionMethod::tangent);
    const double e = std::exp(1.0);
    ASSERT_TRUE(model);
    EXPECT_NEAR(model->L, 2 + 7 * (3 - e), 1e-8);
    EXPECT_NEAR(model->K, -3, 1e-13);
    // 1 - (1 + x) exp(-x) = 1 - 1/e at x = 2.146193...
    const double x = model->T1 / 7 + (3 - e);
    EXPECT_NEAR((1 + x) * std::exp(-x), 1 / e, 1e-9);

    const auto by_slope = reduce(reducible(Sopdt{.K = -3, .T1 = 7, .T2 = 7}),
                                 {.method = ReductionMethod::tangent, .tangent_time = TangentTime::by_slope});
    ASSERT_TRUE(by_slope);
    EXPECT_NEAR(by_slope->T1, 7 * e, 1e-7);
}

TEST(Tangent, AgreesWithTheReferenceOnEveryPlantOfTheBatch) {
    ASSERT_EQ(test::reference_rows().size(), 94u);
    for (const auto& row : test::reference_rows()) {
        const auto& fotd = row.at("fotd");
        const auto model = reduced(test::plant_of(row), ReductionMethod::tangent);
        ASSERT_TRUE(model) << row.at("id") << ": " << model.error().message;
        EXPECT_EQ(model->integrators, fotd.at("integrating").get<bool>() ? 1 : 0) << row.at("id");
        const auto close = [&](double value, double reference, const char* name) {
            EXPECT_NEAR(value, reference, 1e-5 * std::abs(reference)) << row.at("id") << " " << name;
        };
        close(model->K, fotd.at("Kp_or_Kv"), "K");
        close(model->L, fotd.at("L"), "L");
        close(model->T1, fotd.at("T"), "T");
    }
}

TEST(Tangent, IntegratingPlantGivesTheAsymptoteOfItsRamp) {
    // 2 (1 - 3 s) e^(-s)/(s (5 s + 1)): the ramp lags by 1 + 5 + 3.
    expect_model(reduced(TransferFunction{.num = {-6, 2}, .den = {5, 1, 0}, .L = 1}, ReductionMethod::tangent), 1, 2, 0,
                 0, 9);
}

TEST(Tangent, WarnsWhereTheResponseRings) {
    const auto model = reduced(OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.1}, ReductionMethod::tangent);
    ASSERT_TRUE(model);
    ASSERT_EQ(model->warnings.size(), 1u);
    EXPECT_EQ(model->warnings[0].code, "not-monotone");
}

TEST(Tangent, RefusesAResponseThatJumps) {
    const auto model = reduced(TransferFunction{.num = {1, 2}, .den = {1, 1}}, ReductionMethod::tangent);
    ASSERT_FALSE(model);
    EXPECT_THAT(model.error().message, HasSubstr("jumps at once"));
    EXPECT_THAT(model.error().message, HasSubstr("Choose the reduction half_rule, or the method robust"));
}

// Arrieta, Vilanova & Alfaro's process: 1/((s + 1)(0.5 s + 1)(0.25 s + 1)(0.125 s + 1)); published 1.247, 0.691. The
// times follow from the closed-form response by bisection: t25 = 1.049808, t75 = 2.419805.
TEST(TwoPoint123c, ReproducesThePublishedFourthOrderModel) {
    const Zpk plant{.K = 64, .zeros = {}, .poles = {-1.0, -2.0, -4.0, -8.0}};
    const auto model = reduced(plant, ReductionMethod::two_point_123c);
    expect_model(model, 0, 1, 0.9103 * (2.419805 - 1.049808), 0, 1.2620 * 1.049808 - 0.2620 * 2.419805, 2e-6);
    EXPECT_NEAR(model->T1, 1.24711, 1e-4);
    EXPECT_NEAR(model->L, 0.69087, 1e-4);
    EXPECT_TRUE(model->warnings.empty());
    EXPECT_FALSE(model->exact);
}

TEST(TwoPoint123c, DeadTimeGainAndTimeScaleCarryOver) {
    const Zpk plant{.K = -3 * 64, .zeros = {}, .poles = {-0.1, -0.2, -0.4, -0.8}, .L = 7};
    // Ten times slower, so that K of the Zpk is 1e-4 times its previous value.
    Zpk slow = plant;
    slow.K *= 1e-4;
    expect_model(reduced(slow, ReductionMethod::two_point_123c), 0, -3, 12.47109, 0, 7 + 6.908683, 2e-6);
}

TEST(TwoPoint123c, IntegratingPlantKeepsItsSlopeAndItsLagWhereAsked) {
    const Zpk plant{.K = 128, .zeros = {}, .poles = {0.0, -1.0, -2.0, -4.0, -8.0}, .L = 1};
    // The ramp's asymptote: dead time plus lags; with a lag: the two points of the slope.
    expect_model(reduced(plant, ReductionMethod::two_point_123c), 1, 2, 0, 0, 1 + 1.875);
    expect_model(reduced(plant, ReductionMethod::two_point_123c, ReducedOrder::second), 1, 2, 1.247109, 0, 1.6908683,
                 2e-6);
}

TEST(TwoPoint123c, RefusesResponsesThatLeadTheStep) {
    const auto jumps = reduced(TransferFunction{.num = {4, 2}, .den = {4, 2.2}}, ReductionMethod::two_point_123c);
    ASSERT_FALSE(jumps);
    EXPECT_THAT(jumps.error().message, HasSubstr("123c does not apply: the step response jumps past 75 %"));
    EXPECT_THAT(jumps.error().message, HasSubstr("Choose the reduction half_rule"));
    // A fast rise to 70 %, then a slow tail.
    const auto tailed = reduced(TransferFunction{.num = {7, 1}, .den = {1, 10.1, 1}}, ReductionMethod::two_point_123c);
    ASSERT_FALSE(tailed);
    EXPECT_THAT(tailed.error().message, HasSubstr("which gives a negative dead time, -"));
}

TEST(Reduction, EveryMethodIsFoundByItsWord) {
    for (const auto method : {ReductionMethod::automatic, ReductionMethod::half_rule, ReductionMethod::tangent,
                              ReductionMethod::two_point_123c, ReductionMethod::min_ise, ReductionMethod::min_iae,
                              ReductionMethod::min_itae})
        EXPECT_EQ(reduction_method(to_string(method)), method);
}

TEST(Reduction, APlantOfTheFormIsTakenAsItIsByEveryMethod) {
    for (const auto method : {ReductionMethod::automatic, ReductionMethod::half_rule, ReductionMethod::tangent,
                              ReductionMethod::two_point_123c}) {
        const auto model = reduced(Fopdt{.K = -2, .T = 10, .L = 3}, method);
        expect_model(model, 0, -2, 10, 0, 3);
        EXPECT_TRUE(model->exact);
        expect_model(reduced(Ipdt{.K = 0.1, .L = 4}, method), 1, 0.1, 0, 0, 4);
        expect_model(reduced(Fopdt{.K = 5, .T = 0, .L = 3}, method), 0, 5, 0, 0, 3);
        const auto second = reduced(Ipdt{.K = 0.1, .L = 4, .T = 6}, method, ReducedOrder::second);
        expect_model(second, 1, 0.1, 6, 0, 4);
        EXPECT_TRUE(second->exact);
    }
    EXPECT_FALSE(reduced(Ipdt{.K = 0.1, .L = 4, .T = 6}, ReductionMethod::automatic)->exact);
}

TEST(Reduction, AutomaticFallsBackOnTheOtherMethod) {
    // Oscillatory: no half rule. With a jump: no tangent.
    EXPECT_TRUE(reduce(reducible(OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.2, .L = 1}),
                       {.preferred = ReductionMethod::half_rule}));
    EXPECT_TRUE(reduce(reducible(TransferFunction{.num = {1, 2}, .den = {1, 1}, .L = 1}),
                       {.preferred = ReductionMethod::tangent}));
}

TEST(Reduction, AutomaticNamesBothReasonsWhereNeitherMethodApplies) {
    // As many zeros as poles, and oscillatory poles.
    const auto model = reduced(TransferFunction{.num = {1, 1, 2}, .den = {1, 0.1, 1}}, ReductionMethod::automatic);
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().where, "plant");
    EXPECT_THAT(model.error().message, HasSubstr("half_rule: the plant has poles with damping 0.05"));
    EXPECT_THAT(model.error().message, HasSubstr("tangent: the step response jumps at once"));
}

TEST(Reduction, NamesTheReasonForPlantsBeyondIt) {
    const auto message = [](const Plant& plant) {
        const auto model = reduced(plant, ReductionMethod::automatic);
        return model ? std::string("reduced") : model.error().where + ": " + model.error().message;
    };
    EXPECT_THAT(message(Fopdt{.K = 1, .T = -2, .L = 1}), HasSubstr("plant: The plant is unstable (a pole at 0.5)"));
    EXPECT_THAT(message(OscillatorySopdt{.K = 1, .T = 0.5, .zeta = 0}), HasSubstr("undamped oscillation at 2 rad"));
    EXPECT_THAT(message(TransferFunction{.num = {1, 0}, .den = {1, 2, 1}}), HasSubstr("zero at s = 0"));
    EXPECT_THAT(message(TransferFunction{.num = {1}, .den = {1, 0, 0}}),
                HasSubstr("2 integrators; the model can have at most 1"));
}

TEST(Reduction, ModelsBecomePlantsOfTheirForm) {
    const auto plant = [](ReducedModel model) { return model.plant(); };
    EXPECT_EQ(std::get<Fopdt>(plant({.K = 2, .T1 = 3, .L = 1})).T, 3);
    EXPECT_EQ(std::get<Sopdt>(plant({.K = 2, .T1 = 3, .T2 = 1, .L = 1})).T2, 1);
    EXPECT_EQ(std::get<Ipdt>(plant({.integrators = 1, .K = 2, .T1 = 3, .L = 1})).T, 3);
    EXPECT_EQ(std::get<TransferFunction>(plant({.integrators = 2, .K = 2, .L = 1})).den,
              (std::vector<double>{1, 0, 0}));
}

}  // namespace
}  // namespace tunewright
