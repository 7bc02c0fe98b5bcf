// Feedforward: exact inverses, the peak that none avoids, integrals, and optima against an independent search.
#include "engine/structure/feedforward.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

FeedforwardProblem toolbox_late(double jump) {
    return {first_order(1.5, 60, 15), first_order(1, 15, 0), pi(4.0 / 3, 60), jump};
}

const FeedforwardVariant& variant(const FeedforwardResult& result, FeedforwardKind kind) {
    return result.variants[std::size_t(kind)];
}

TEST(Feedforward, WhereTheValveIsAsQuickTheInverseIsExact) {
    for (const double Ld : {15.0, 45.0}) {
        const auto result =
            design_feedforward({first_order(1.5, 60, 15), first_order(0.8, 15, Ld), pi(4.0 / 3, 60), 10}, {});
        ASSERT_TRUE(result);
        const double none = *variant(*result, FeedforwardKind::none).figures.IAE;
        for (const auto kind : {FeedforwardKind::inverse, FeedforwardKind::optimum}) {
            EXPECT_LT(*variant(*result, kind).figures.IAE, 1e-6 * none) << Ld;
            EXPECT_NEAR(variant(*result, kind).compensator->Lf, Ld - 15, 1e-12);
        }
        EXPECT_EQ(result->peak_bound, 0);
    }
}

TEST(Feedforward, NoCompensatorAvoidsThePeakUntilTheValveActs) {
    // Kd (1 - exp(-a/Td)) with a = Td = 15.
    const auto result = design_feedforward(toolbox_late(12), {});
    ASSERT_TRUE(result);
    const double bound = 1 - std::exp(-1.0);
    EXPECT_NEAR(result->peak_bound, bound, 1e-6);
    EXPECT_DOUBLE_EQ(result->late, 15);
    for (const FeedforwardVariant& one : result->variants)
        if (one.why_not.empty()) {
            EXPECT_GE(std::abs(one.figures.peak), bound - 1e-6);
        }
    EXPECT_NEAR(variant(*result, FeedforwardKind::optimum).figures.peak, bound, 1e-6);
}

TEST(Feedforward, TheIntegralOfTheErrorFollowsFromTheStaticGainWhateverTheDynamics) {
    FeedforwardProblem problem = toolbox_late(12);
    for (const Feedforward& f : {Feedforward{.Kf = 0.5, .Tz = 40, .Tp = 7}, {.Kf = 0.9, .Tz = 3, .Tp = 30, .Lf = 4}}) {
        const auto judged = judge_feedforward(problem, f);
        ASSERT_TRUE(judged);
        // Of the error r - y: (K Kf - Kd) Ti/(K Kp).
        EXPECT_NEAR(*judged->figures.IE, (1.5 * f.Kf - 1) * 60 / (1.5 * 4 / 3), 1e-6 * *judged->figures.IAE);
    }
}

TEST(Feedforward, OptimaAreAtMostTwoPerMilleAboveThoseOfAnIndependentSearch) {
    struct Row {
        FeedforwardProblem problem;
        double IAE;
    };
    for (const Row& row : {Row{toolbox_late(4), 11.423},
                           {toolbox_late(12), 9.1329},
                           {{first_order(1, 10, 4), first_order(1, 10, 1), pi(1.25, 12), 10}, 0.864},
                           // A lateness far below nearly equal lags: a short lead, far from the inverse's.
                           {{first_order(1.5365096, 26.183933, 3.293216865),
                             first_order(2.319267788, 26.425585, 2.644077366),
                             {.Kp = 2.8734774998421395,
                             .Ti = 7.9906450917413006,
                             .Td = 1.4475927511336069,
                             .filter = {FilterType::measurement_second_order, 0.1447592751133607}},
                             14.517547},
                            0.07126}}) {
        const auto result = design_feedforward(row.problem, {});
        ASSERT_TRUE(result);
        const FeedforwardVariant& best = variant(*result, FeedforwardKind::optimum);
        EXPECT_LE(*best.figures.IAE, 1.002 * row.IAE);
        EXPECT_LE(std::abs(best.compensator->jump()), row.problem.jump * (1 + 1e-9));
        for (const FeedforwardVariant& other : result->variants)
            if (other.compensator && std::abs(other.compensator->jump()) <= row.problem.jump) {
                EXPECT_LE(*best.figures.IAE, *other.figures.IAE * (1 + 1e-5));
            }
    }
}

TEST(Feedforward, TheFiguresOfThePublishedExampleAreThoseOfAnIndependentProgram) {
    // process-control-toolbox, article 8, Ld = 0: without noise 366.3/12, 442.7/12, 256.7/12; peak 7.585/12.
    const auto result = design_feedforward(toolbox_late(12), {});
    ASSERT_TRUE(result);
    EXPECT_NEAR(*variant(*result, FeedforwardKind::none).figures.IAE, 366.3 / 12, 0.01);
    EXPECT_NEAR(*variant(*result, FeedforwardKind::gain).figures.IAE, 442.7 / 12, 0.01);
    EXPECT_NEAR(*variant(*result, FeedforwardKind::inverse).figures.IAE, 256.7 / 12, 0.01);
    EXPECT_NEAR(*variant(*result, FeedforwardKind::rule).figures.IAE, 12.62, 0.01);
    EXPECT_NEAR(variant(*result, FeedforwardKind::inverse).figures.peak, 7.585 / 12, 1e-4);
}

TEST(Feedforward, AGivenCompensatorIsOnlyJudged) {
    FeedforwardProblem problem = toolbox_late(12);
    problem.given = Feedforward{.Kf = 0.51, .Tz = 53.6, .Tp = 2.28};
    const auto result = design_feedforward(problem, {});
    ASSERT_TRUE(result);
    ASSERT_EQ(result->variants.size(), 2u);
    EXPECT_EQ(result->variants[1].kind, FeedforwardKind::given);
    EXPECT_NEAR(*result->variants[1].figures.IAE, 9.133, 0.02);
    EXPECT_EQ(result->variants[1].IAE_if_wrong.size(), 4u);
}

TEST(Feedforward, AnUnstableLoopAndUnequalIntegratorsAreRefused) {
    FeedforwardProblem problem = toolbox_late(10);
    problem.feedback = pi(100, 60);
    auto result = design_feedforward(problem, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, "feedback");
    problem = toolbox_late(10);
    problem.disturbance = *LinearPlant::make(Plant(Ipdt{.K = 1}));
    result = design_feedforward(problem, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, "disturbance");
}

TEST(Feedforward, PlantAndDisturbanceMayBothIntegrate) {
    const FeedforwardProblem problem{
        .plant = *LinearPlant::make(Plant(Zpk{.K = 0.05, .zeros = {}, .poles = {0.0}, .L = 2})),
        .disturbance = *LinearPlant::make(Plant(Zpk{.K = 0.05, .zeros = {}, .poles = {0.0}, .L = 3})),
        .feedback = pi(3, 20)};
    const auto found = design_feedforward(problem, {});
    ASSERT_TRUE(found) << found.error().message;
    // The valve is earlier: the inverse, a gain of 1 after 1, is exact.
    EXPECT_LT(*found->variants.back().figures.IAE, 1e-6 * *found->variants.front().figures.IAE);
    FeedforwardProblem unstable = problem;
    unstable.plant = first_order(1, 5, 1);
    unstable.disturbance = first_order(-1, -15, 0);
    const auto refused = design_feedforward(unstable, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "disturbance");
}

TEST(Feedforward, NoVariantExceedsTheFirstMove) {
    for (const double jump : {0.1, 0.5, 0.7, 2.0, 6.0}) {
        const FeedforwardProblem problem{.plant = first_order(1.5, 60, 15),
                                         .disturbance = first_order(1, 15, 0),
                                         .feedback = pi(1.3333, 60),
                                         .jump = jump};
        const auto found = design_feedforward(problem, {});
        ASSERT_TRUE(found) << found.error().message;
        for (const FeedforwardVariant& variant : found->variants) {
            if (!variant.why_not.empty() || !variant.compensator) continue;
            EXPECT_LE(std::abs(variant.u_start), jump * (1 + 1e-6)) << jump << " " << name_of(variant.kind);
            EXPECT_GT(variant.compensator->Kf, 0) << jump << " " << name_of(variant.kind);
        }
        EXPECT_EQ(found->variants.size(), 5u);
    }
}

}  // namespace
}  // namespace tunewright::structure
