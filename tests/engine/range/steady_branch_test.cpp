#include "engine/range/equations/steady_branch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/range/experiments.h"
#include "engine/range/model/range_model.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/range/range_plants.h"

namespace tunewright::range {
namespace {

using range_tests::conical_tank;
using range_tests::jacketed_reactor;
using range_tests::neutralisation;

TEST(SteadyBranch, OfTheConicalTankIsItsClosedFormAlongOutputAndInput) {
    const auto by_level =
        SteadyBranch::follow({.plant = conical_tank(20), .along = Along::output, .from = 4, .to = 40});
    ASSERT_TRUE(by_level) << by_level.error().message;
    for (const double h : {4.0, 5.3, 17.0, 39.9, 40.0}) {
        const auto state = by_level->at(h);
        ASSERT_TRUE(state);
        EXPECT_NEAR(state->u, 40 * std::sqrt(h), 1e-9 * state->u);
        const StateSpace linear = by_level->linearised(*state);
        const double area = 0.09 * std::numbers::pi * h * h;
        EXPECT_NEAR(linear.A[0][0], -40 / (2 * std::sqrt(h)) / area, 1e-9 * std::abs(linear.A[0][0]));
        EXPECT_NEAR(linear.B[0], 1 / area, 1e-12);
        EXPECT_EQ(linear.L, 2);
    }
    const auto by_flow =
        SteadyBranch::follow({.plant = conical_tank(20), .along = Along::input, .from = 100, .to = 240});
    ASSERT_TRUE(by_flow);
    EXPECT_NEAR(by_flow->at(200)->y, 25, 1e-9);
}

TEST(SteadyBranch, AlongAParameterHoldsTheOutputOrTheInput) {
    EquationsRange range{.plant = conical_tank(25), .along = Along::parameter, .parameter = "c", .from = 20, .to = 60};
    const auto held = SteadyBranch::follow(range);
    ASSERT_TRUE(held) << held.error().message;
    EXPECT_NEAR(held->at(30)->u, 30 * 5, 1e-8);
    EXPECT_NEAR(held->at(30)->y, 25, 1e-9);
    EXPECT_EQ(held->linearised(*held->at(30)).A.size(), 1u);
    EXPECT_NEAR(std::get<double>(held->plant_at(*held->at(30)).parameters[0].value), 30, 1e-12);
    range.hold_output = false;
    const auto free = SteadyBranch::follow(range);
    ASSERT_TRUE(free);
    EXPECT_NEAR(free->at(50)->y, std::pow(200.0 / 50, 2), 1e-8);
}

/// The steady-state jacket temperature for the reactor temperature T, in closed form.
double jacket_at_rest(double T) {
    const double k = 34930800.0 * std::exp(-11843.0 / (1.987 * T));
    return T + (T - 298 - 11.92 * 10 * k / (1 + k)) / 0.3;
}

/// Its maximum or minimum between two temperatures: golden section on the closed form.
double turning_point(double low, double high, double sign) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    while (high - low > 1e-9) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (sign * jacket_at_rest(a) > sign * jacket_at_rest(b) ? high : low) =
            sign * jacket_at_rest(a) > sign * jacket_at_rest(b) ? b : a;
    }
    return 0.5 * (low + high);
}

TEST(SteadyBranch, FindsTheFoldsOfTheJacketedReactor) {
    const auto branch =
        SteadyBranch::follow({.plant = jacketed_reactor(), .along = Along::output, .from = 305, .to = 370});
    ASSERT_TRUE(branch) << branch.error().message;
    ASSERT_EQ(branch->input_folds().size(), 2u);
    const double upper = turning_point(315, 335, 1), lower = turning_point(345, 365, -1);
    EXPECT_NEAR(branch->input_folds()[0].state.y, upper, 1e-3);
    EXPECT_NEAR(branch->input_folds()[0].state.u, jacket_at_rest(upper), 1e-6);
    EXPECT_TRUE(branch->input_folds()[0].upper);
    EXPECT_NEAR(branch->input_folds()[1].state.y, lower, 1e-3);
    EXPECT_NEAR(branch->input_folds()[1].state.u, jacket_at_rest(lower), 1e-6);
    const auto model = model_of_branch(std::make_shared<SteadyBranch>(*branch));
    ASSERT_TRUE(model);
    EXPECT_EQ((*model)->warnings().size(), 2u);
    // Between the folds one pole is in the right half-plane (van Heerden's slope condition), outside none.
    EXPECT_EQ((*model)->at(339)->nominal->unstable_poles(), 1);
    EXPECT_EQ((*model)->at(312)->nominal->unstable_poles(), 0);
    EXPECT_EQ((*model)->at(368)->nominal->unstable_poles(), 0);
}

TEST(SteadyBranch, AlongTheInputNamesTheFoldAndWhereThePlantJumps) {
    const auto branch =
        SteadyBranch::follow({.plant = jacketed_reactor(), .along = Along::input, .from = 290, .to = 310});
    ASSERT_FALSE(branch);
    EXPECT_EQ(branch.error().kind, ErrorKind::invalid_argument);
    EXPECT_EQ(branch.error().where, "range/to");
    EXPECT_EQ(branch.error().message,
              "The branch of steady states turns back at Tc = 305.91 (y = 323.491, Tc = 305.91): with a larger Tc "
              "there is none near, and the plant jumps to y = 373.604. Give a range that ends before that point, or "
              "choose a range along the output, which the loop controls.");
    // The end of the jump has the same Tc.
    EXPECT_NEAR(jacket_at_rest(373.604), 305.91, 0.1);
}

TEST(SteadyBranch, PassesNeutralityWhereThePHMovesAThousandTimesFaster) {
    const auto branch =
        SteadyBranch::follow({.plant = neutralisation(0.9), .along = Along::output, .from = 4, .to = 10});
    ASSERT_TRUE(branch) << branch.error().message;
    for (double pH = 4; pH <= 10; pH += 0.25) {
        const auto state = branch->at(pH);
        ASSERT_TRUE(state) << pH;
        const double w = std::pow(10, pH - 14) - std::pow(10, -pH);
        EXPECT_NEAR(state->u, (0.01 - w) / (0.01 + w), 1e-9) << pH;
    }
}

std::string refusal(const EquationsRange& range) {
    const auto branch = SteadyBranch::follow(range);
    return branch ? "" : branch.error().where + ": " + branch.error().message;
}

TEST(SteadyBranch, RefusesRangesThatCannotBe) {
    EXPECT_EQ(refusal({.plant = conical_tank(20), .along = Along::output, .from = 5, .to = 5}),
              "range/from: The range goes from 5 to 5; from must be less than to.");
    EXPECT_EQ(refusal({.plant = conical_tank(20), .along = Along::parameter, .parameter = "d", .from = 1, .to = 2}),
              "range/parameter: \"d\" is not a parameter of this plant.");
    // 400 is the input's largest value, and sqrt(h) = 400/40.
    const std::string beyond = refusal({.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 120});
    EXPECT_EQ(beyond.substr(0, 24), "range/to: Resting at y =");
    EXPECT_NE(beyond.find("beyond its limits of 0 to 400"), std::string::npos) << beyond;
    // y = x^2 has no steady state below y = 0, whatever u.
    NonlinearPlant square = scalar_plant("u - x", 1, 1);
    square.output = "x^2";
    EXPECT_NE(refusal({.plant = square, .along = Along::output, .from = -1, .to = 2}).find("turns back at y = "),
              std::string::npos);
}

TEST(PlaceTests, OfAStepShowThePlaceOwnGain) {
    const auto branch = SteadyBranch::follow({.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 32});
    const auto tests = test_places(*branch, {.kind = ExperimentKind::step, .at = {10, 20, 32}, .size = 0.5}, {});
    ASSERT_TRUE(tests) << tests.error().message;
    for (const PlaceTest& place : *tests) {
        const auto& step = std::get<StepTest>(place.test);
        const double h = place.rest.at, after = std::pow((40 * std::sqrt(h) + 0.5) / 40, 2) - h;
        EXPECT_NEAR(step.y.back(), after, 0.02 * after);
    }
}

TEST(PlaceTests, OfARelayFindEachPlaceOwnUltimatePeriod) {
    const auto branch = SteadyBranch::follow({.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 32});
    const auto tests = test_places(*branch, {.kind = ExperimentKind::relay, .at = {10, 32}, .y_part = 0.002}, {});
    ASSERT_TRUE(tests) << tests.error().message;
    for (const PlaceTest& place : *tests) {
        // A relay on K e^(-Ls)/(T s + 1): half a period is L + T ln(2 - e^(-L/T)).
        const double h = place.rest.at, T = 0.09 * std::numbers::pi * h * h * 2 * std::sqrt(h) / 40;
        const double period = 2 * (2 + T * std::log(2 - std::exp(-2 / T)));
        EXPECT_NEAR(std::get<NonlinearRelayTest>(place.test).Pu, period, 0.01 * period);
    }
}

TEST(PlaceTests, RefusePlacesOutsideTheRange) {
    const auto branch = SteadyBranch::follow({.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 32});
    const auto tests = test_places(*branch, {.at = {10, 40}}, {});
    ASSERT_FALSE(tests);
    EXPECT_EQ(tests.error().where, "experiment/at");
    EXPECT_EQ(tests.error().message, "The place 40 lies outside the range of 10 to 32.");
}

}  // namespace
}  // namespace tunewright::range
