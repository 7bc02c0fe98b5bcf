#include "engine/controller/schedule/schedule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "engine/range/design_range.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/schedule/point_evaluation.h"
#include "engine/simulation/linear/indices.h"
#include "engine/tuning/robust/robust.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/range/dense_loop.h"
#include "tests/engine/range/range_plants.h"

namespace tunewright::range {
namespace {

using range_tests::Complex;
using range_tests::PlantFunction;

/// The linear plant of a place, derived by hand in the test, and the data for evaluating loops on it.
struct HandPlant {
    PlantFunction P;
    Plant plant;  // the same for the engine's simulation and single design
    int unstable_poles = 0;
    double low = 1e-3, high = 1e3;  // of the relevant frequencies
};

/// K e^(-Ls)/(T s + 1) of the conical tank: T h' = ..., from its equation's derivatives at rest.
HandPlant tank_at(double h) {
    const double area = 0.09 * std::numbers::pi * h * h, by_h = 40 / (2 * std::sqrt(h));
    const double K = 1 / by_h, T = area / by_h, L = 2;
    return {.P = [=](Complex s) { return K * std::exp(-s * L) / (T * s + 1.0); }, .plant = Fopdt{K, T, L}};
}

/// C (sI - A)^-1 B e^(-Ls) of two states, y the first (CA) or the second (T).
HandPlant of_two_states(double a11, double a12, double a21, double a22, double b2, bool first, double L) {
    HandPlant hand;
    hand.P = [=](Complex s) {
        const Complex det = (s - a11) * (s - a22) - a12 * a21;
        return (first ? Complex(a12 * b2) : (s - a11) * b2) / det * std::exp(-s * L);
    };
    hand.plant = StateSpace{
        .A = {{a11, a12}, {a21, a22}}, .B = {0, b2}, .C = {first ? 1.0 : 0.0, first ? 0.0 : 1.0}, .D = 0, .L = L};
    const double trace = a11 + a22, det = a11 * a22 - a12 * a21;
    hand.unstable_poles = det < 0 ? 1 : trace > 0 ? 2 : 0;
    hand.low = 1e-6;  // near a fold a pole passes through 0
    hand.high = 1e4;
    return hand;
}

HandPlant coolant_at(double CA) {
    const double k = (1 - CA) / CA, T = 1e4 / std::log(7.2e10 / k), kT = k * 1e4 / (T * T);
    // 0 = 350 - T + 200 k CA + qc/100 (1 - exp(-700/qc)) (350 - T), for qc.
    const double removed = (350 - T + 200 * k * CA) / (T - 350) * 100;
    double low = 1, high = 700;
    const auto effect = [](double qc) { return qc * (1 - std::exp(-700 / qc)); };
    for (int i = 0; i < 200; ++i) (effect(0.5 * (low + high)) < removed ? low : high) = 0.5 * (low + high);
    const double qc = 0.5 * (low + high), x = 700 / qc, g = effect(qc) / 100;
    const double b = (1 - std::exp(-x) - x * std::exp(-x)) / 100 * (350 - T);
    return of_two_states(-1 - k, -kT * CA, 200 * k, -1 + 200 * kT * CA - g, b, true, 0.1);
}

HandPlant jacket_at(double T) {
    const double k = 34930800.0 * std::exp(-11843.0 / (1.987 * T)), kT = k * 11843.0 / (1.987 * T * T);
    const double CA = 10 / (1 + k);
    return of_two_states(-1 - k, -kT * CA, 11.92 * k, -1 + 11.92 * kT * CA - 0.3, 0.3, false, 0.02);
}

HandPlant endothermic_at(double T) {
    const double k = 4.71e8 * std::exp(-8000 / T), kT = k * 8000 / (T * T), CA = 1 / (1 + k);
    return of_two_states(-1 - k, -kT * CA, -200 * k, -1 - 200 * kT * CA - 1, 1, false, 0);
}

/// pH = log10((w + sqrt(w^2 + 4 Kw))/(2 Kw)); dpH/dw = 1/(ln 10 sqrt(w^2 + 4 Kw)).
HandPlant acid_at(double pH) {
    const double hydroxide = std::pow(10, pH - 14), w = hydroxide - 1e-14 / hydroxide;
    const double u = (0.01 - w) / (0.01 + w), slope = 1 / (std::log(10) * std::hypot(w, 2e-7));
    const double a = (1 + u) / 10, b = -(0.01 + w) / 10, K = b / a * slope, T = 1 / a;
    return {.P = [=](Complex s) { return K * std::exp(-0.5 * s) / ((T * s + 1.0) * (0.5 * s + 1.0)); },
            .plant = Sopdt{K, T, 0.5, 0.5}};
}

struct RangeCase {
    const char* name;
    EquationsRange range;
    std::function<HandPlant(double)> at;
    std::size_t rows;  ///< at most
    double limit = 1.4;
    Interpolation interpolation = Interpolation::linear_in_gains;
};

std::vector<RangeCase> cases() {
    using namespace range_tests;
    const EquationsRange tank{.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 32};
    const EquationsRange wide_tank{.plant = conical_tank(20), .along = Along::output, .from = 4, .to = 40};
    const EquationsRange cooled{.plant = coolant_reactor(), .along = Along::output, .from = 0.06, .to = 0.12};
    const EquationsRange jacketed{.plant = jacketed_reactor(), .along = Along::output, .from = 311, .to = 368};
    const EquationsRange papers{.plant = cstr("T"), .along = Along::output, .from = 380, .to = 420};
    const EquationsRange acid{.plant = neutralisation(0.9), .along = Along::output, .from = 10, .to = 11};
    const EquationsRange wide_acid{.plant = neutralisation(0.9), .along = Along::output, .from = 9.5, .to = 11.5};
    return {
        {"conical tank, gain of the rate 1 to 10", tank, tank_at, 6},
        {"conical tank, linear times", tank, tank_at, 6, 1.4, Interpolation::linear_in_times},
        {"reactor with coolant flow", cooled, coolant_at, 6},
        {"jacketed reactor through its unstable states", jacketed, jacket_at, 6, 1.8},
        {"reactor of the papers", papers, endothermic_at, 6},
        {"neutralisation, gain 1 to 8", acid, acid_at, 6},
        // More than six rows are needed: the gain of the rate varies by a factor of 100, that of the pH by 58.
        {"conical tank, gain of the rate 1 to 100", wide_tank, tank_at, 9},
        {"neutralisation, gain 1 to 58", wide_acid, acid_at, 9},
    };
}

double load_IAE(const Plant& plant, const IdealPid& pid) {
    const auto linear = LinearPlant::make(plant);
    const auto response = simulate_linear(*linear, to_parallel(pid), {.r = 0, .d = 1}, ResponseOptions());
    return integral_of_absolute_error(response.nodes, 0, response.error_integral_final);
}

class ScheduleOfEquations : public testing::TestWithParam<int> {};

TEST_P(ScheduleOfEquations, HoldsItsLimitsAt200PlacesAndCostsLittleMoreThanTheOwnOptima) {
    const RangeCase range = cases()[std::size_t(GetParam())];
    SCOPED_TRACE(range.name);
    const auto branch = SteadyBranch::follow(range.range);
    ASSERT_TRUE(branch) << branch.error().message;
    const auto model = model_of_branch(std::make_shared<SteadyBranch>(*branch));
    ASSERT_TRUE(model) << model.error().message;
    RangeOptions options;
    options.limits.Ms = options.limits.Mt = range.limit;
    options.interpolation = range.interpolation;
    const auto design = design_range({.scheduling = {}, .model = *model, .options = options, .hold_between = true}, {});
    ASSERT_TRUE(design) << design.error().message;
    ASSERT_TRUE(design->schedule);
    const Schedule& schedule = design->schedule->schedule;
    EXPECT_LE(schedule.rows.size(), range.rows);
    EXPECT_TRUE(design->schedule->holds_limits);
    EXPECT_TRUE(design->schedule->within_allowance);
    for (int i = 0; i < 200; ++i) {
        const double at = range.range.from + (range.range.to - range.range.from) * (i + 0.5) / 200;
        const HandPlant hand = range.at(at);
        const IdealPid pid = settings_at(schedule, at);
        const auto peaks = range_tests::dense_peaks(hand.P, pid, hand.low, hand.high, 5000, hand.unstable_poles);
        EXPECT_TRUE(peaks.stable) << at;
        EXPECT_LE(peaks.Ms, range.limit * (1 + 1e-4)) << at;
        EXPECT_LE(peaks.Mt, range.limit * (1 + 1e-4)) << at;
    }
    // Ten places compared with a single design by the method robust, with the range's filter rule.
    for (int i = 0; i < 10; ++i) {
        const double at = range.range.from + (range.range.to - range.range.from) * (i + 0.37) / 10;
        const HandPlant hand = range.at(at);
        const IdealPid pid = settings_at(schedule, at);
        RobustOptions own{.Ms = range.limit, .Mt = range.limit};
        if (hand.unstable_poles > 0 || dead_time(hand.plant) > 0)
            own.filter.Tf_over_Td = 0.1;
        else
            own.filter.Tf = pid.filter.Tf;
        const auto linear = LinearPlant::make(hand.plant);
        const auto single = tune_robust({.plant = hand.plant, .linear = *linear, .dead_time_std = {}}, own, {});
        ASSERT_TRUE(single) << single.error().message;
        EXPECT_LE(load_IAE(hand.plant, pid), 1.051 * load_IAE(hand.plant, single->controller)) << at;
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, ScheduleOfEquations, testing::Range(0, 8));

TEST(Schedule, InterpolatesAsTheUsersControllerDoes) {
    Schedule two{.interpolation = Interpolation::linear_in_gains,
                 .hysteresis = 0,
                 .rows = {{.at = 0, .Kp = 1, .Ti = 2, .Td = 0.5, .Tf = 0.05},
                          {.at = 10, .Kp = 3, .Ti = 6, .Td = 1.5, .Tf = 0.15}}};
    const IdealPid by_gains = settings_at(two, 2.5);
    EXPECT_DOUBLE_EQ(by_gains.Kp, 1.5);
    EXPECT_NEAR(1 / by_gains.Ti, 0.75 / 2 + 0.25 / 6, 1e-15);
    EXPECT_DOUBLE_EQ(by_gains.Td, 0.75);
    EXPECT_NEAR(by_gains.filter.Tf, 0.075, 1e-15);
    two.interpolation = Interpolation::linear_in_times;
    EXPECT_DOUBLE_EQ(settings_at(two, 2.5).Ti, 3);
    EXPECT_DOUBLE_EQ(settings_at(two, -5).Kp, 1);
    EXPECT_DOUBLE_EQ(settings_at(two, 50).Kp, 3);
}

TEST(Schedule, StepsKeepARowHalfTheHysteresisBeyondItsBorder) {
    const Schedule steps{
        .interpolation = Interpolation::steps,
        .hysteresis = 1,
        .rows = {{.at = 0, .Kp = 1, .Ti = 1}, {.at = 5, .Kp = 2, .Ti = 1}, {.at = 8, .Kp = 3, .Ti = 1}}};
    EXPECT_EQ(row_after(steps, 0, 5.4), 0u);
    EXPECT_EQ(row_after(steps, 0, 5.6), 1u);
    EXPECT_EQ(row_after(steps, 1, 4.6), 1u);
    EXPECT_EQ(row_after(steps, 1, 4.4), 0u);
    EXPECT_EQ(row_after(steps, 0, 20), 2u);
    EXPECT_EQ(in_use(steps, 5.2).size(), 2u);
    EXPECT_EQ(in_use(steps, 6).size(), 1u);
}

std::vector<RangePoint> five_points() {
    std::vector<RangePoint> points;
    for (int k = 0; k < 5; ++k)
        points.push_back({10.0 + 20 * k, family_of(Fopdt{std::pow(3, k / 4.0), 10 * std::pow(0.5, k / 4.0), 2})});
    return points;
}

TEST(Schedule, BetweenPointsHoldsItsLimitsOnThePlantsThatTheInterpolationStates) {
    const auto model = model_of_points(five_points(), Between::parameters);
    const auto design = design_range({.scheduling = {"load", "%"}, .model = *model, .options = {}}, {});
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_EQ(design->verdict, Verdict::schedule);
    for (int i = 0; i < 200; ++i) {
        const double at = 10 + 80 * (i + 0.5) / 200, share = (at - 10) / 80;
        const double K = std::pow(3, share), T = 10 * std::pow(0.5, share);
        const auto peaks = range_tests::dense_peaks([&](Complex s) { return K * std::exp(-2.0 * s) / (T * s + 1.0); },
                                                    settings_at(design->schedule->schedule, at), 1e-3, 1e3, 3000);
        EXPECT_TRUE(peaks.stable) << at;
        EXPECT_LE(std::max(peaks.Ms, peaks.Mt), 1.4 * (1 + 1e-4)) << at;
    }
}

TEST(Schedule, HoldsItsLimitsOnTheUncertainPlantsOfEveryPoint) {
    auto points = five_points();
    for (RangePoint& point : points) {
        Fopdt plant = std::get<Fopdt>(point.family.nominal());
        plant.uncertainty.K = FactorRange{0.85, 1.2};
        plant.uncertainty.L = FactorRange{0.9, 1.2};
        point.family = family_of(plant);
    }
    const auto model = model_of_points(points, Between::parameters);
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}}, {});
    ASSERT_TRUE(design) << design.error().message;
    ASSERT_TRUE(design->schedule) << design->why_no_schedule;
    EXPECT_TRUE(design->schedule->holds_limits);
    for (int i = 0; i <= 40; ++i)
        for (const double k : {0.85, 1.0, 1.2})
            for (const double l : {0.9, 1.2}) {
                const double share = i / 40.0, K = k * std::pow(3, share), T = 10 * std::pow(0.5, share), L = 2 * l;
                const auto peaks =
                    range_tests::dense_peaks([&](Complex s) { return K * std::exp(-s * L) / (T * s + 1.0); },
                                             settings_at(design->schedule->schedule, 10 + 80 * share), 1e-3, 1e3, 3000);
                EXPECT_TRUE(peaks.stable);
                EXPECT_LE(std::max(peaks.Ms, peaks.Mt), 1.4 * (1 + 1e-4)) << share << " " << k << " " << l;
            }
}

TEST(Schedule, OfAGivenNumberOfRowsHasThem) {
    const auto model = model_of_points(five_points(), Between::parameters);
    for (const int rows : {1, 3, 6}) {
        RangeOptions options;
        options.rows = rows;
        const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
        ASSERT_TRUE(design) << design.error().message;
        ASSERT_TRUE(design->schedule) << design->why_no_schedule;
        EXPECT_EQ(design->schedule->schedule.rows.size(), std::size_t(rows));
        EXPECT_TRUE(design->schedule->holds_limits);
        EXPECT_EQ(design->schedule->within_allowance, rows == 6);
        EXPECT_EQ(design->schedule->warnings.empty(), rows == 6);
    }
}

TEST(Schedule, OfStepsHoldsItsLimitsOverEachRowsPartAndTheHysteresis) {
    const auto model = model_of_points(five_points(), Between::parameters);
    RangeOptions options;
    options.interpolation = Interpolation::steps;
    options.rows = 5;
    const auto design = design_range({.scheduling = {}, .model = *model, .options = options}, {});
    ASSERT_TRUE(design) << design.error().message;
    const Schedule& schedule = design->schedule->schedule;
    EXPECT_NEAR(schedule.hysteresis, 0.02 * 80, 1e-12);
    for (std::size_t k = 0; k < schedule.rows.size(); ++k) {
        const double from = std::max(10.0, schedule.rows[k].at - 0.8);
        const double to = k + 1 < schedule.rows.size() ? schedule.rows[k + 1].at + 0.8 : 90;
        for (int i = 0; i <= 40; ++i) {
            const double share = (from + (to - from) * i / 40 - 10) / 80, K = std::pow(3, share),
                         T = 10 * std::pow(0.5, share);
            const auto peaks =
                range_tests::dense_peaks([&](Complex s) { return K * std::exp(-2.0 * s) / (T * s + 1.0); },
                                         controller_of(schedule.rows[k]), 1e-3, 1e3, 3000);
            EXPECT_TRUE(peaks.stable);
            EXPECT_LE(std::max(peaks.Ms, peaks.Mt), 1.4 * (1 + 1e-4));
        }
    }
}

TEST(Range, OneSettingIsEnoughWhereThePlantHardlyVaries) {
    const auto model =
        model_of_points({{0, family_of(Fopdt{1, 10, 2})}, {1, family_of(Fopdt{1.02, 10.2, 2})}}, Between::parameters);
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}}, {});
    ASSERT_TRUE(design);
    EXPECT_EQ(design->verdict, Verdict::one_setting);
    ASSERT_TRUE(design->schedule);
    EXPECT_EQ(design->schedule->schedule.rows.size(), 1u);
}

TEST(Range, NamesTheWorstPlaceOfEveryQuantity) {
    const auto model = model_of_points(five_points(), Between::parameters);
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}}, {});
    ASSERT_TRUE(design);
    ASSERT_EQ(design->one_curve.worst.size(), 3u);
    // The cost of one setting, which the highest gain limits, is largest at the lowest gain.
    EXPECT_EQ(design->one_curve.worst[2].quantity, Quantity::relative_IAE);
    EXPECT_DOUBLE_EQ(design->one_curve.worst[2].at, 10);
    EXPECT_NEAR(*design->one_curve.worst[2].value, design->one->points.front().relative_IAE.value_or(0), 1e-3);
    EXPECT_GE(design->one_curve.places.size(), 61u);
    for (const auto& place : design->schedule_curve.places) EXPECT_LE(place.relative_IAE.value_or(99), 1.0505);
}

TEST(Range, ProgressNeverFallsAndEndsAtOne) {
    const auto model = model_of_points(five_points(), Between::parameters);
    double last = 0;
    RunControl control;
    control.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last);
        last = progress.fraction;
    };
    ASSERT_TRUE(design_range({.scheduling = {}, .model = *model, .options = {}}, control));
    EXPECT_EQ(last, 1);
}

TEST(Range, StoppedAfterOneSettingKeepsIt) {
    const auto model = model_of_points(five_points(), Between::parameters);
    std::stop_source stop;
    RunControl control{.stop = stop.get_token(), .progress = {}, .now_ms = {}};
    control.progress = [&](const Progress& progress) {
        if (progress.stage == "schedule") stop.request_stop();
    };
    const auto design = design_range({.scheduling = {}, .model = *model, .options = {}}, control);
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_TRUE(design->partial);
    ASSERT_TRUE(design->one);
    EXPECT_LE(largest_excess(design->one_curve), 2e-5);
}

TEST(Range, RefusesOptionsThatMeanNothing) {
    const auto fault = [](auto change) {
        RangeOptions options;
        change(options);
        const auto faults = option_faults(options);
        return faults.size() == 1 ? faults.front().where + ": " + faults.front().message : std::string("?");
    };
    EXPECT_EQ(fault([](auto& o) { o.limits.Ms = 1; }), "options/Ms: Ms is 1; must be above 1 and at most 4.");
    EXPECT_EQ(fault([](auto& o) { o.allowance = 0; }),
              "options/allowance: allowance is 0; must be above 0 and at most 1.");
    EXPECT_EQ(fault([](auto& o) { o.rows = 21; }), "options/rows: rows is 21; must be 1 to 20.");
    EXPECT_EQ(fault([](auto& o) { o.b = 1.5; }), "options/b: b is 1.5; must be 0 to 1.");
    EXPECT_EQ(fault([](auto& o) { o.hysteresis = 0.5; }),
              "options/hysteresis: hysteresis is 0.5 of the range; must be 0 to 0.2.");
}

}  // namespace
}  // namespace tunewright::range
