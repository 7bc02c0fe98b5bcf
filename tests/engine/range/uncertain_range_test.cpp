// Findings about settings on uncertain plants: the worst plant counts, not the nominal one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/range/design_range.h"
#include "tests/engine/range/dense_loop.h"

namespace tunewright::range {
namespace {

using range_tests::Complex;

std::vector<RangePoint> uncertain_lags(double K_high, double T_low) {
    Fopdt left{1, 5, 1}, right{2, 7, 1};
    for (Fopdt* plant : {&left, &right}) {
        plant->uncertainty.K = FactorRange{1 / K_high, K_high};
        plant->uncertainty.T = FactorRange{T_low, 1 / T_low};
    }
    return {{1, family_of(left)}, {2, family_of(right)}};
}

const Schedule& given_rows() {
    static const Schedule rows{
        .interpolation = Interpolation::linear_in_gains,
        .hysteresis = 0,
        .rows = {{.at = 1, .Kp = 1.2, .Ti = 5, .Td = 0, .Tf = 0}, {.at = 2, .Kp = 0.8, .Ti = 7, .Td = 0, .Tf = 0}}};
    return rows;
}

Expected<RangeDesign> judged(const std::vector<RangePoint>& points) {
    RangeOptions options;
    options.controller = ControllerKind::PI;
    const auto model = model_of_points(points, Between::parameters);
    if (!model) return model.error();
    return judge_schedule({.scheduling = {}, .model = *model, .options = options}, given_rows(), {});
}

const WorstPoint& worst_of(const RangeCurve& curve, Quantity quantity) {
    return *std::ranges::find(curve.worst, quantity, &WorstPoint::quantity);
}

/// The largest Ms at the corners of the uncertainty, over the range, by a dense sweep.
double dense_Ms(double K_high, double T_low) {
    double largest = 0;
    for (int i = 0; i <= 60; ++i) {
        const double share = i / 60.0;
        for (const double k : {1 / K_high, K_high})
            for (const double t : {T_low, 1 / T_low}) {
                const double K = k * std::pow(2, share), T = t * 5 * std::pow(1.4, share);
                const auto plant = [&](Complex s) { return K * std::exp(-s) / (T * s + 1.0); };
                const auto peaks =
                    range_tests::dense_peaks(plant, settings_at(given_rows(), 1 + share), 1e-3, 1e3, 4000);
                largest = std::max(largest, peaks.stable ? peaks.Ms : 99);
            }
    }
    return largest;
}

TEST(UncertainRange, AGivenScheduleIsJudgedOnTheWorstOfTheUncertainPlants) {
    const auto design = judged(uncertain_lags(2, 0.5));
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_FALSE(design->schedule->holds_limits);
    const auto& Ms = worst_of(design->schedule_curve, Quantity::Ms).value;
    ASSERT_TRUE(Ms);
    EXPECT_NEAR(*Ms, dense_Ms(2, 0.5), 2e-3);
    EXPECT_GT(*Ms, 2.4);
    for (const PointFigures& place : design->schedule_curve.places) EXPECT_LE(place.Ms.value_or(99), *Ms * (1 + 1e-4));
}

TEST(UncertainRange, AnUnstableCornerLeavesNoFigure) {
    const auto design = judged(uncertain_lags(4, 0.25));
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_FALSE(design->schedule->holds_limits);
    EXPECT_FALSE(worst_of(design->schedule_curve, Quantity::Ms).value);
    EXPECT_FALSE(worst_of(design->schedule_curve, Quantity::Mt).value);
}

TEST(UncertainRange, OneSettingThatExceedsALimitBetweenThePointsIsWarnedOf) {
    Sopdt left{0.256, 0.456, 0.233, 0.15}, right{17.7, 22.1, 5.41, 0.879};
    left.uncertainty.K = right.uncertainty.K = FactorRange{0.5, 2};
    const auto model = model_of_points({{48, family_of(left)}, {49, family_of(right)}}, Between::parameters);
    RangeOptions options;
    options.limits.Ms = 1.7;
    const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
    ASSERT_TRUE(design) << design.error().message;
    ASSERT_TRUE(design->one);
    for (const PointCost& point : design->one->points) EXPECT_LE(point.Ms.value_or(99), 1.7 * (1 + 1e-4)) << point.at;
    const auto& Ms = worst_of(design->one_curve, Quantity::Ms).value;
    double curve = 0;
    for (const PointFigures& place : design->one_curve.places) curve = std::max(curve, place.Ms.value_or(99));
    EXPECT_GT(curve, 1.75);
    EXPECT_NEAR(Ms.value_or(0), curve, 1e-2);
    EXPECT_TRUE(std::ranges::any_of(design->warnings,
                                    [](const Warning& warning) { return warning.code == "limit-exceeded-between"; }));
}

}  // namespace
}  // namespace tunewright::range
