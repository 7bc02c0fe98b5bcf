// A schedule between given points: the limits are most nearly reached at kinks of the plant or the settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/range/design_range.h"
#include "engine/range/equations/steady_branch.h"
#include "tests/engine/range/dense_loop.h"
#include "tests/engine/range/range_plants.h"

namespace tunewright::range {
namespace {

using range_tests::Complex;

struct Point {
    double at, K, T, L;
};

/// ln of K, T and L linear between neighbours.
Point between(const std::vector<Point>& points, double at) {
    std::size_t k = 1;
    while (k + 1 < points.size() && at > points[k].at) ++k;
    const Point &a = points[k - 1], &b = points[k];
    const double part = (at - a.at) / (b.at - a.at);
    const auto mean = [&](double x, double y) { return x * std::pow(y / x, part); };
    return {at, mean(a.K, b.K), mean(a.T, b.T), mean(a.L, b.L)};
}

/// Kp, Ti (or 1/Ti), Td and Tf linear between neighbouring rows.
IdealPid settings_between(const Schedule& schedule, double at) {
    const auto& rows = schedule.rows;
    std::size_t k = 1;
    while (k + 1 < rows.size() && at > rows[k].at) ++k;
    const ScheduleRow &a = rows[k - 1], &b = rows[k];
    const double part = (at - a.at) / (b.at - a.at);
    const auto mean = [&](double x, double y) { return x + part * (y - x); };
    IdealPid pid{.Kp = mean(a.Kp, b.Kp), .Ti = mean(a.Ti, b.Ti), .Td = mean(a.Td, b.Td)};
    if (schedule.interpolation == Interpolation::linear_in_gains) pid.Ti = 1 / mean(1 / a.Ti, 1 / b.Ti);
    if (a.Tf > 0 || b.Tf > 0) pid.filter = {FilterType::measurement_second_order, mean(a.Tf, b.Tf)};
    return pid;
}

Expected<std::shared_ptr<const RangeModel>> model_of(const std::vector<Point>& points) {
    std::vector<RangePoint> given;
    for (const Point& p : points) given.push_back({p.at, family_of(Fopdt{p.K, p.T, p.L})});
    return model_of_points(given, Between::parameters);
}

std::vector<Point> six_points() {
    return {{5, 1.754, 132.3, 255.5},  {55, 0.352, 86.18, 342.1},  {58, 2.178, 27.07, 192.8},
            {74, 1.683, 67.96, 100.7}, {93, 0.8283, 36.07, 117.5}, {98, 1.772, 164.5, 45.42}};
}

struct Set {
    std::vector<Point> points;
    ControllerKind controller;
    double Ms, Mt;
    Interpolation interpolation;
    std::optional<int> rows = {};
};

// If only places between rows were checked, these would exceed a limit by 0.03 %, 0.10 % and 0.07 %: at a point next to
// a row, and between two points that are close together.
TEST(Schedule, HoldsItsLimitsWhereThePlantBends) {
    const Set sets[] = {
        {{{9, 5.509, 43.0, 2.216}, {38, 2.509, 122.6, 7.76}, {76, 2.056, 47.48, 2.449}},
         ControllerKind::PI,
         1.46294,
         1.3,
         Interpolation::linear_in_times},
        {six_points(), ControllerKind::PID, 1.3572, 1.3, Interpolation::linear_in_gains, 5},
        {{{7, 0.6197, 1.621, 0.9641},
          {25, 0.6278, 2.197, 0.9665},
          {55, 0.6464, 1.808, 0.9243},
          {63, 0.7551, 1.605, 1.051},
          {67, 0.7584, 1.936, 1.022},
          {97, 0.7654, 1.611, 0.9912}},
         ControllerKind::PID,
         1.98363,
         1.98363,
         Interpolation::linear_in_times},
    };
    for (const Set& set : sets) {
        RangeOptions options;
        options.controller = set.controller;
        options.limits.Ms = set.Ms;
        options.limits.Mt = set.Mt;
        options.interpolation = set.interpolation;
        options.rows = set.rows;
        const auto model = model_of(set.points);
        ASSERT_TRUE(model);
        const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
        ASSERT_TRUE(design && design->schedule);
        ASSERT_TRUE(design->schedule->holds_limits);
        const double low = set.points.front().at, high = set.points.back().at;
        std::vector<double> places;
        for (int i = 0; i <= 800; ++i) places.push_back(low + (high - low) * i / 800);
        for (const Point& p : set.points) places.push_back(p.at);
        double excess = -1;
        for (const double at : places) {
            const Point p = between(set.points, at);
            const auto plant = [&](Complex s) { return p.K * std::exp(-s * p.L) / (p.T * s + 1.0); };
            const auto peaks = range_tests::dense_peaks(plant, settings_between(design->schedule->schedule, at),
                                                        1e-3 / (p.T + p.L), 300 / std::min(p.T, p.L), 2000);
            EXPECT_TRUE(peaks.stable) << at;
            excess = std::max({excess, peaks.Ms / set.Ms - 1, peaks.Mt / set.Mt - 1});
        }
        EXPECT_LE(excess, 5e-5) << set.points.size() << " points";
    }
}

// Only a third of a per cent of the range, about 57.2, exceeds a limit, by 0.1 %: none of the curve's evenly spaced
// places lies there.
TEST(Schedule, ThatIsGivenIsFoundToExceedALimitBetweenTheCurvesPlaces) {
    const Schedule given{.interpolation = Interpolation::linear_in_gains,
                         .hysteresis = 0,
                         .rows = {{5, 0.228167, 190.358, 88.2156, 8.82156},
                                  {54.406, 0.441218, 178.125, 79.9511, 7.99511},
                                  {57.894, 0.103589, 99.4963, 31.446, 3.1446},
                                  {86.375, 0.171959, 66.3315, 46.2529, 4.62529},
                                  {98, 0.522742, 81.159, 20.3231, 2.03231}}};
    RangeOptions options;
    options.limits.Ms = 1.3573;
    options.limits.Mt = 1.3;
    const auto model = model_of(six_points());
    ASSERT_TRUE(model);
    const auto judged = judge_schedule({.scheduling = {}, .model = *model, .options = options}, given, {});
    ASSERT_TRUE(judged && judged->schedule);
    EXPECT_FALSE(judged->schedule->holds_limits);
    const WorstPoint& worst = *std::ranges::find(judged->schedule_curve.worst, Quantity::Ms, &WorstPoint::quantity);
    EXPECT_NEAR(worst.at, 57.18, 0.1);
    EXPECT_NEAR(worst.value.value_or(0), 1.3586, 3e-4);  // 1.35858 at 57.196 by a dense sweep

    // However small the excess over a limit, a warning reports it with figures that differ; within the limits there is
    // none.
    for (const double excess : {0.1, 1e-3, 1e-4, -1e-4}) {
        options.limits.Ms = *worst.value / (1 + excess);
        options.limits.Mt = 2;
        const auto again = judge_schedule({.scheduling = {}, .model = *model, .options = options}, given, {});
        ASSERT_TRUE(again && again->schedule);
        const auto warning = std::ranges::find(again->warnings, "schedule-above-limit", &Warning::code);
        EXPECT_EQ(again->schedule->holds_limits, excess < 0) << excess;
        ASSERT_EQ(warning != again->warnings.end(), excess > 0) << excess;
        if (excess < 0) continue;
        const std::string& text = warning->detail;
        const double is = std::stod(text.substr(text.find("Ms is ") + 6)),
                     limit = std::stod(text.substr(text.find("limit of ") + 9));
        EXPECT_GT(is, limit) << text;
        EXPECT_NEAR(std::stod(text.substr(text.find("(by ") + 4)) / (100 * excess), 1, 0.02) << text;
    }
}

// A product's table may extend beyond the range: its settings there are not evaluated.
TEST(Schedule, ThatIsGivenMayHaveRowsBeyondTheRange) {
    const auto branch =
        SteadyBranch::follow({.plant = range_tests::conical_tank(20), .along = Along::output, .from = 10, .to = 32});
    ASSERT_TRUE(branch);
    const auto model = model_of_branch(std::make_shared<SteadyBranch>(*branch));
    ASSERT_TRUE(model);
    const Schedule given{.interpolation = Interpolation::linear_in_gains,
                         .hysteresis = 0,
                         .rows = {{5, 5, 60, 0, 0}, {20, 8, 80, 0, 0}, {45, 12, 100, 0, 0}}};
    RangeOptions options;
    options.controller = ControllerKind::PI;
    const auto judged = judge_schedule({.scheduling = {}, .model = *model, .options = options}, given, {});
    ASSERT_TRUE(judged) << judged.error().message;
    EXPECT_TRUE(judged->schedule->holds_limits);
    EXPECT_EQ(judged->schedule_curve.places.front().at, 10);
    EXPECT_EQ(judged->schedule_curve.places.back().at, 32);
}

}  // namespace
}  // namespace tunewright::range
