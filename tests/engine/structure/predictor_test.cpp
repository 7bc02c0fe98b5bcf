// Predictors: lambda over Ms, the window of the dead time, published examples, identities.
#include "engine/structure/predictor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <utility>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

PredictorController smith(const PredictorModel& model, Rational C) {
    return {.model = model, .C = std::move(C), .F = {{1}, {1}}};
}

/// max |1 - e^(-jw)/(lambda j w + 1)| on a fine grid with a parabola through the highest point.
double Ms_of_lambda(double lambda) {
    const auto S = [&](double x) {
        const std::complex<double> s(0, std::exp(x));
        return std::abs(1.0 - std::exp(-s) / (lambda * s + 1.0));
    };
    double best = -5;
    for (double x = -5; x < 4; x += 1e-3)
        if (S(x) > S(best)) best = x;
    const double h = 1e-3, a = S(best - h), b = S(best), c = S(best + h);
    return b + (a - c) * (a - c) / (8 * (2 * b - a - c));
}

TEST(Predictor, LambdaOverTheDeadTimeDependsOnMsAlone) {
    struct Row {
        double Ms, lambda;
    };
    for (const Row& row : {Row{1.3, 2.05640078},
                           {1.4, 1.35276275},
                           {1.5, 0.93791184},
                           {1.59, 0.68691849},
                           {1.6, 0.66368750},
                           {1.7, 0.46675645},
                           {1.8, 0.31434552},
                           {1.9, 0.18406553}}) {
        for (const double T : {0.3, 4.0}) {
            const auto design = design_predictor({.K = 2, .T = T, .L = 1}, first_order(2, T, 1), {.Ms = row.Ms}, {});
            ASSERT_TRUE(design);
            EXPECT_NEAR(design->controller.lambda, row.lambda, 1e-6) << row.Ms;
            EXPECT_NEAR(Ms_of_lambda(design->controller.lambda), row.Ms, 1e-9) << row.Ms;
            EXPECT_NEAR(design->figures.Ms, row.Ms, 1e-8) << row.Ms;
            EXPECT_NEAR(*design->figures.load->IE, -2 * (1 + design->controller.lambda), 1e-5) << row.Ms;
            EXPECT_NEAR(*design->figures.setpoint->IAE, 1 + design->controller.lambda, 1e-4) << row.Ms;
        }
    }
}

TEST(Predictor, TheWindowOfTheDeadTimeFallsOffACliffThatMsDoesNotShow) {
    struct Row {
        double Ms, up, down;
    };
    for (const Row& row : {Row{1.4, 2.87, 1}, {1.59, 1.89, 1}, {1.8, 0.520, 0.474}, {1.9, 0.278, 0.307}}) {
        const auto design = design_predictor({}, first_order(1, 1, 1), {.Ms = row.Ms}, {});
        ASSERT_TRUE(design && design->figures.dead_time_up && design->figures.dead_time_down);
        EXPECT_NEAR(*design->figures.dead_time_up, row.up, 0.006) << row.Ms;
        EXPECT_NEAR(*design->figures.dead_time_down, row.down, 0.0006) << row.Ms;
    }
}

TEST(Predictor, BothSidesOfTheWindowAreTheBordersOfStability) {
    const PredictorModel model{};
    const auto design = design_predictor(model, first_order(1, 1, 1), {.Ms = 1.85}, {});
    ASSERT_TRUE(design);
    const double up = *design->figures.dead_time_up, down = *design->figures.dead_time_down;
    for (const double share : {0.99, 1.01}) {
        const auto later = judge_predictor(first_order(1, 1, 1 + share * up), design->controller),
                   earlier = judge_predictor(first_order(1, 1, 1 - share * down), design->controller);
        ASSERT_TRUE(later && earlier);
        EXPECT_EQ(later->stable, share < 1);
        EXPECT_EQ(earlier->stable, share < 1);
    }
}

TEST(Predictor, AWantedWindowIsHeldAndSaysThatItLimitsTheDesign) {
    const auto sharp = design_predictor({}, first_order(1, 1, 1), {.Ms = 1.9, .dead_time_error = 0.5}, {});
    ASSERT_TRUE(sharp);
    EXPECT_TRUE(sharp->limited_by_dead_time);
    EXPECT_LT(sharp->figures.Ms, 1.9);
    EXPECT_GE(std::min(*sharp->figures.dead_time_up, *sharp->figures.dead_time_down), 0.5 - 1e-4);
}

TEST(Predictor, ThePidIsComparedAtTheMsThatThePredictorHas) {
    const LinearPlant plant = first_order(1, 1, 1);
    for (const std::optional<double> window : {std::optional<double>(), std::optional(0.5)}) {
        const auto found = design_predictor({}, plant, {.Ms = 1.9, .dead_time_error = window}, {});
        ASSERT_TRUE(found && found->pid);
        const auto loop = Loop::make(plant, to_parallel(*found->pid));
        const auto peaks = stable_peaks(loop);
        ASSERT_TRUE(peaks);
        EXPECT_NEAR(peaks->S.value, found->figures.Ms, 1e-3) << "the limit is 1.9";
    }
}

TEST(Predictor, MathWorksExampleIsRecomputed) {
    // After Ingimundarson and Hagglund (2001); figures of an independent program.
    const PredictorModel model{5.6, 40.2, 93.9};
    PredictorController controller = smith(model, {{0.574, 0.574 / 40.2}, {1, 0}});
    const LinearPlant plant = first_order(5.6, 40.2, 93.9);
    const auto figures = judge_predictor(plant, controller);
    ASSERT_TRUE(figures && figures->stable);
    EXPECT_NEAR(figures->Ms, 1.938878292, 4e-5);
    EXPECT_NEAR(*figures->load->IAE, 595.8748432, 0.12);
    EXPECT_NEAR(*figures->setpoint->IAE, 106.40622200, 0.02);
    EXPECT_NEAR(*figures->dead_time_up, 19.17083247, 0.04);
    EXPECT_NEAR(*figures->dead_time_down, 18.66564425, 0.04);
    controller.F = {{1}, {20, 1}};
    EXPECT_NEAR(judge_predictor(plant, controller)->Ms, 1.85845195, 4e-5);
    controller.F = {{10, 1}, {100, 1}};
    EXPECT_NEAR(judge_predictor(plant, controller)->Ms, 1.468, 5e-4);
}

TEST(Predictor, TheControllerItselfIsUnstableBeyondThePublishedDeadTime) {
    // Astrom and Hagglund (2006), chapter 8: 1/(s + 1) with 1.8 + 4/s; 2.9940.
    double low = 2, high = 4;
    for (int i = 0; i < 20; ++i) {
        const double L = (low + high) / 2;
        const PredictorModel model{1, 1, L};
        const auto figures = judge_predictor(first_order(1, 1, L), smith(model, {{1.8, 4}, {1, 0}}));
        ASSERT_TRUE(figures);
        EXPECT_TRUE(figures->stable);
        (figures->controller_unstable_poles > 0 ? high : low) = L;
    }
    EXPECT_NEAR(low, 2.9940, 1e-4);
}

TEST(Predictor, TheFilteredPredictorHasThePublishedIntegralAndOptima) {
    struct Row {
        double T, Ms, IAE;
    };
    for (const Row& row : {Row{0.5, 1.4, 2.505},
                           {0.5, 1.59, 1.691},
                           {1, 1.4, 2.349},
                           {1, 1.59, 1.682},
                           {2, 1.4, 2.326},
                           {2, 1.59, 1.578},
                           {5, 1.4, 1.926},
                           {5, 1.59, 1.164}}) {
        const auto design = design_predictor({.T = row.T}, first_order(1, row.T, 1),
                                             {.kind = PredictorKind::filtered_smith, .Ms = row.Ms}, {});
        ASSERT_TRUE(design);
        EXPECT_LE(*design->figures.load->IAE, 1.002 * row.IAE) << row.T << " " << row.Ms;
        EXPECT_LE(design->figures.Ms, row.Ms * (1 + 1e-5));
        EXPECT_NEAR(*design->figures.load->IE, -(1 + 2 * design->controller.Tf - design->controller.beta), 1e-4);
    }
}

TEST(Predictor, ThePredictivePiIsTheSmithPredictorWhoseLambdaIsTheLag) {
    struct Row {
        double T, Ms;
    };
    for (const Row& row : {Row{2, 1.306}, {0.5, 1.681}, {0.1, 1.962}}) {  // L/T = 0.5, 2, 10
        const auto design =
            design_predictor({.T = row.T}, first_order(1, row.T, 1), {.kind = PredictorKind::predictive_pi}, {});
        ASSERT_TRUE(design);
        EXPECT_NEAR(design->figures.Ms, row.Ms, 5e-4);
        EXPECT_NEAR(*design->figures.load->IE, -(1 + row.T), 1e-4);
    }
}

TEST(Predictor, LimitsHoldOnAPlantThatTheModelDescribesRoughly) {
    struct Row {
        PredictorKind kind;
        LinearPlant plant;
        std::optional<double> dead_time_error;
    };
    const PredictorModel model{1, 5, 4};
    for (const Row& row : {Row{PredictorKind::smith, transfer({1.1}, {4, 5.8, 1}, 4.2), {}},
                           {PredictorKind::filtered_smith, transfer({1.1}, {4, 5.8, 1}, 3.8), 0.3},
                           {PredictorKind::smith, transfer({0.9}, {4, 5.8, 1}, 4), 0.4},
                           {PredictorKind::smith, first_order(1.2, 5, 4), {}}}) {
        const auto design = design_predictor(model, row.plant,
                                             {.kind = row.kind, .Ms = 1.6, .dead_time_error = row.dead_time_error}, {});
        ASSERT_TRUE(design) << design.error().message;
        EXPECT_LE(design->figures.Ms, 1.6 * (1 + 1e-5));
        const double window = std::min(*design->figures.dead_time_up, *design->figures.dead_time_down);
        EXPECT_GE(window, row.dead_time_error.value_or(0) * 4 * (1 - 1e-4));
        EXPECT_TRUE(row.dead_time_error || design->figures.Ms > 1.6 * (1 - 1e-4)) << "the quickest that holds";
    }
}

TEST(Predictor, AFilteredPredictorKeepsLowLimitsOnDeadTimesFarAboveTheLag) {
    // With a Tf far above the lag beta is negative and the peak rises again.
    RandomNumbers random(9);
    for (int i = 0; i < 8; ++i) {
        const double T = random.log_uniform(0.1, 1), Ms = random.log_uniform(1.38, 1.55);
        const auto design =
            design_predictor({.T = T}, first_order(1, T, 1), {.kind = PredictorKind::filtered_smith, .Ms = Ms}, {});
        ASSERT_TRUE(design) << T << ": " << design.error().message;
        EXPECT_LE(design->figures.Ms, Ms * (1 + 1e-5)) << T;
        EXPECT_GE(design->figures.Ms, Ms * (1 - 1e-4)) << T;
    }
    // For T = L/2 no Tf has a peak below 1.3299.
    const auto refused = design_predictor({.T = 0.503}, first_order(1, 0.503, 1),
                                          {.kind = PredictorKind::filtered_smith, .Ms = 1.32}, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::no_feasible_controller);
}

TEST(Predictor, OnAnUnstableModelNothingIsSimulated) {
    const auto design = design_predictor({-1, -4, 0.5}, first_order(-1, -4, 0.5),
                                         {.kind = PredictorKind::filtered_smith, .Ms = 1.9}, {});
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_TRUE(design->figures.stable);
    EXPECT_FALSE(design->figures.load);
    EXPECT_FALSE(design->figures.load.why.empty());
}

TEST(Predictor, ModelsAreReadFromPlantsOfFirstOrder) {
    const auto lag = model_of(transfer({2}, {10, 1}, 3));
    ASSERT_TRUE(lag);
    EXPECT_NEAR(lag->K, 2, 1e-12);
    EXPECT_NEAR(lag->T, 10, 1e-12);
    const auto integrator = model_of(transfer({2}, {1, 0}, 3));
    ASSERT_TRUE(integrator && integrator->integrating);
    EXPECT_FALSE(model_of(transfer({2}, {10, 7, 1}, 3)));
    EXPECT_FALSE(model_of(transfer({3, 2}, {10, 1}, 3)));
}

TEST(Predictor, WhatADesignCannotServeIsRefusedWithItsPlace) {
    const auto place = [](const PredictorModel& model, const PredictorDesign& design) {
        const auto result = design_predictor(model, first_order(1, 1, 1), design, {});
        return result ? std::string("none") : result.error().where;
    };
    EXPECT_EQ(place({.L = 0}, {}), "model/L");
    EXPECT_EQ(place({.K = 0}, {}), "model");
    EXPECT_EQ(place({}, {.Ms = 2}), "Ms");
    EXPECT_EQ(place({.integrating = true}, {}), "kind");
}

}  // namespace
}  // namespace tunewright::structure
