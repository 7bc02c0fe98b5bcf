// Ranges on which no number of rows stays within the allowance, or on which a search from the optima finds nothing:
// there is still a schedule if one is possible.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/range/design_range.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/schedule/point_evaluation.h"

namespace tunewright::range {
namespace {

RangeDesign designed(const std::vector<RangePoint>& points, const RangeOptions& options) {
    const auto model = model_of_points(points, Between::parameters);
    EXPECT_TRUE(model) << model.error().message;
    const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
    EXPECT_TRUE(design) << design.error().message;
    return design ? *design : RangeDesign();
}

bool warned(const RangeDesign& design, const std::string& code) {
    return std::ranges::any_of(design.warnings, [&](const Warning& warning) { return warning.code == code; });
}

/// Checks that the design holds its limits, and costs no more than the one setting, as far as interpolated optima show.
void expect_worth_having(const RangeDesign& design) {
    ASSERT_TRUE(design.one) << design.why_no_one;
    ASSERT_TRUE(design.schedule) << design.why_no_schedule;
    EXPECT_TRUE(design.schedule->holds_limits);
    EXPECT_LE(largest_excess(design.schedule_curve), 6e-5);
    EXPECT_LE(design.schedule->worst_relative_IAE, 1.03 * largest_relative_IAE(design.one_curve));
}

OscillatorySopdt oscillating(double K, double T, double zeta, double L) {
    return {.K = K, .T = T, .zeta = zeta, .L = L};
}

std::vector<RangePoint> wildly_varying() {
    return {{-29, family_of(oscillating(3.152, 6.366, 0.5315, 0.237))},
            {-13, family_of(oscillating(0.05158, 5.871, 0.7789, 0.1148))},
            {17, family_of(oscillating(0.07566, 3.359, 1.981, 9.682))}};
}

TEST(ScheduleWhereNoneSuffices, TheOneThatComesNearestIsAnsweredWithAWarning) {
    RangeOptions options;
    options.limits.Ms = 1.7;
    options.filter.Tf = 0.05;
    const auto design = designed(wildly_varying(), options);
    expect_worth_having(design);
    EXPECT_FALSE(design.schedule->within_allowance);
    EXPECT_LT(design.schedule->worst_relative_IAE, 1.3);
    EXPECT_EQ(design.schedule->schedule.rows.size(), std::size_t(kMaxRows));
    EXPECT_TRUE(warned(design, "schedule-over-allowance"));
}

/// Strong acid and strong base: the gain of the pH rises and falls by a factor of a thousand.
NonlinearPlant strong_acid_and_base() {
    const std::string root = "sqrt(z^2 + 4*Kw)";
    return {.states = {{"w", -0.005}, {"z", -0.005}},
            .parameters = {{"V", 5.0}, {"F", 2.0}, {"Ca", 0.02}, {"Cb", 0.05}, {"Kw", 1e-14}, {"te", 0.2}},
            .equations = {{"w", "(q*Cb - F*Ca - (F + q)*w)/V"}, {"z", "(w - z)/te"}},
            .input = {.name = "q", .nominal = 0.5, .min = 0.0, .max = 3.0},
            .output = "z < 0 ? -log((-z + " + root + ")/2)/log(10) : log((z + " + root + ")/(2*Kw))/log(10)",
            .L = 0.3};
}

TEST(ScheduleWhereNoneSuffices, HoldsForAGainThatRisesAndFallsAThousandfold) {
    const auto branch =
        SteadyBranch::follow({.plant = strong_acid_and_base(), .along = Along::output, .from = 4, .to = 10});
    ASSERT_TRUE(branch) << branch.error().message;
    const auto model = model_of_branch(std::make_shared<SteadyBranch>(*branch));
    ASSERT_TRUE(model) << model.error().message;
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}, .hold_between = true}, {});
    ASSERT_TRUE(design) << design.error().message;
    ASSERT_TRUE(design->schedule) << design->why_no_schedule;
    EXPECT_TRUE(design->schedule->holds_limits);
    EXPECT_LT(design->schedule->worst_relative_IAE, 1.15);
}

std::vector<RangePoint> four_of_two_lags() {
    return {{0, family_of(Sopdt{1.05, 3.6, 0.443, 7.11})},
            {30, family_of(Sopdt{1.26, 2.87, 0.456, 4.6})},
            {60, family_of(Sopdt{1.46, 2.86, 0.423, 3.97})},
            {100, family_of(Sopdt{1.74, 2.87, 0.332, 2.78})}};
}

TEST(ScheduleWhereNoneSuffices, ASearchInVainBeginsAgainFromTheOneSetting) {
    RangeOptions options;
    options.controller = ControllerKind::PI;
    options.interpolation = Interpolation::linear_in_times;
    options.rows = 2;
    const auto design = designed(four_of_two_lags(), options);
    expect_worth_having(design);
    EXPECT_EQ(design.schedule->schedule.rows.size(), 2u);
}

TEST(ScheduleWhereNoneSuffices, OneRowIsTheOneSettingAtWorst) {
    RangeOptions options;
    options.limits.Ms = 2;
    options.limits.Mt = 1.1;
    options.interpolation = Interpolation::linear_in_times;
    options.rows = 1;
    const auto design = designed({{42, family_of(Fopdt{0.4052, 3.598, 0.1643})},
                                  {43, family_of(Fopdt{3.539, 5.027, 0.3663})},
                                  {60, family_of(Fopdt{0.4322, 9.381, 0.7722})},
                                  {94, family_of(Fopdt{23.92, 27.70, 4.750})},
                                  {100, family_of(Fopdt{0.0593, 0.4470, 0.3777})}},
                                 options);
    if (!warned(design, "limit-exceeded-between")) {
        expect_worth_having(design);
        EXPECT_EQ(design.schedule->schedule.rows.size(), 1u);
    } else {
        ADD_FAILURE() << "the one setting does not keep the limits: no case for this test";
    }
}

TEST(ScheduleWhereNoneSuffices, StepsOfAFewRowsTakeTheOneSettingOverPartsThatHaveNoBetter) {
    RangeOptions options;
    options.limits.Ms = 1.7;
    options.filter.Tf = 0.05;
    options.interpolation = Interpolation::steps;
    for (const int rows : {1, 6}) {
        options.rows = rows;
        const auto design = designed(wildly_varying(), options);
        expect_worth_having(design);
        ASSERT_TRUE(design.schedule);
        EXPECT_EQ(design.schedule->schedule.rows.size(), std::size_t(rows));
    }
}

TEST(ScheduleWhereNoneSuffices, RowsThatALayoutLeavesOverGoIntoTheWidestParts) {
    std::vector<double> at = {0, 4, 10};
    fill_up(at, 5, 10);
    EXPECT_EQ(at, (std::vector<double>{0, 2, 4, 7, 10}));
    std::vector<double> steps = {0};
    fill_up(steps, 2, 6);
    EXPECT_EQ(steps, (std::vector<double>{0, 3}));
}

TEST(ScheduleWhereNoneSuffices, TheWarningsFiguresDiffer) {
    ScheduleDesign design;
    design.worst_relative_IAE = 1.200004;
    remark_cost(design, 0.2);
    ASSERT_EQ(design.warnings.size(), 1u);
    EXPECT_NE(design.warnings[0].detail.find("up to 20.0004 % more"), std::string::npos) << design.warnings[0].detail;
}

/// A pure dead time at one end: no PID with a filter tied to Td is as good there as the PI.
TEST(PIAmongPIDs, IsTakenWhereAPureDeadTimeForbidsTheDerivative) {
    const std::vector<RangePoint> points = {{1, family_of(Fopdt{1, 0, 1})}, {2, family_of(Fopdt{1, 5, 1})}};
    RangeOptions options;
    const auto PID = designed(points, options);
    options.controller = ControllerKind::PI;
    const auto PI = designed(points, options);
    ASSERT_TRUE(PID.one && PI.one);
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_LE(PID.one->points[k].IAE.value_or(99), 1.1 * PI.one->points[k].IAE.value_or(0)) << k;
    EXPECT_EQ(PID.one->points[0].own.Td, 0);
    ASSERT_TRUE(PID.schedule) << PID.why_no_schedule;
    EXPECT_TRUE(PID.schedule->holds_limits);
    EXPECT_EQ(PID.schedule->schedule.rows.front().Td, 0);
    EXPECT_LT(PID.schedule->worst_relative_IAE, 0.7 * largest_relative_IAE(PID.one_curve));
    for (const Interpolation kind : {Interpolation::steps, Interpolation::linear_in_times}) {
        RangeOptions other;
        other.interpolation = kind;
        const auto design = designed(points, other);
        ASSERT_TRUE(design.schedule) << design.why_no_schedule;
        EXPECT_TRUE(design.schedule->holds_limits);
    }
}

}  // namespace
}  // namespace tunewright::range
