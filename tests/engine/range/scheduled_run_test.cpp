#include "engine/range/run/scheduled_run.h"
#include "engine/range/run/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/simulation/nonlinear/nonlinear_response.h"
#include "tests/engine/range/range_plants.h"

namespace tunewright::range {
namespace {

using range_tests::conical_tank;

SteadyBranch tank_branch() {
    return *SteadyBranch::follow({.plant = conical_tank(20), .along = Along::output, .from = 10, .to = 32});
}

/// Suitable for the tank of the tests: gains proportional to its area.
Schedule tank_schedule(Interpolation interpolation) {
    Schedule schedule{.interpolation = interpolation, .hysteresis = 0.5, .rows = {}};
    for (const double h : {10.0, 13.0, 17.4, 23.2, 32.0})
        schedule.rows.push_back({.at = h, .Kp = 0.07 * h * h, .Ti = 3 + 0.2 * (h - 10), .Td = 0.85, .Tf = 0.085});
    return schedule;
}

TEST(ScheduledRun, OfOneRowIsTheLoopThatTheNonlinearResponseSimulates) {
    const IdealPid pid{.Kp = 20, .Ti = 8, .Td = 0.8, .b = 0.6, .filter = {FilterType::measurement_second_order, 0.08}};
    const auto run = run_schedule(tank_branch(), one_row(pid, 10), {{0, 20}, {0, 24}},
                                  {.horizon = 60, .samples = 61, .tolerance = 1e-9});
    ASSERT_TRUE(run) << run.error().message;
    const auto system = NonlinearSystem::make(conical_tank(20));
    NonlinearOptions options;
    options.horizon = 60;
    options.samples = 61;
    const auto known = simulate_nonlinear(*system, to_parallel(pid), {.r = 4, .d = 0}, options);
    for (std::size_t i = 0; i < 61; ++i) {
        EXPECT_NEAR(run->y[i], known.even.y[i] + 20, 2e-5) << i;
        EXPECT_NEAR(run->u[i], known.even.u[i] + system->u_nominal(), 1e-3) << i;
    }
}

TEST(ScheduledRun, DoesNotMoveUWhereRowsSwitch) {
    const auto run = run_schedule(tank_branch(), tank_schedule(Interpolation::steps),
                                  {{0, 10}, {200, 32}, {300, 32}, {500, 10}}, {.horizon = 600, .samples = 6001});
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_GE(run->switches, 8);
    EXPECT_LT(run->largest_bump, 1e-9);
    // Between two samples u does not move more than at the corners of the ramp; it would if a new Kp acted on the error
    // of the ramp.
    for (std::size_t i = 1; i < run->u.size(); ++i) EXPECT_LT(std::abs(run->u[i] - run->u[i - 1]), 1.1) << run->t[i];
    EXPECT_TRUE(run->settled);
}

TEST(ScheduledRun, FollowsARampWithTheErrorThatTheIntegralNeeds) {
    // On a slow ramp u = c sqrt(h) + A(h) h' changes steadily, so e = u' Ti/Kp.
    const auto run = run_schedule(tank_branch(), tank_schedule(Interpolation::linear_in_gains), {{0, 10}, {400, 32}},
                                  {.horizon = 400, .samples = 401});
    ASSERT_TRUE(run);
    const double v = 22.0 / 400;
    for (const std::size_t i : {150u, 250u, 350u}) {
        const double h = run->y[i], area = 0.09 * std::numbers::pi * h * h;
        const double du = 40 / (2 * std::sqrt(h)) * v + 2 * area / h * v * v;
        const IdealPid pid = settings_at(tank_schedule(Interpolation::linear_in_gains), h);
        // The derivative, the lag of the filter and the motion of the settings are of second order in the ramp's slope.
        EXPECT_NEAR(run->target[i] - h, (du * pid.Ti) / pid.Kp, 0.15 * du * pid.Ti / pid.Kp) << h;
    }
}

TEST(ScheduledRun, SaysHowMuchTheSettingsMotionAddsOnALargeStepAndNotOnASlowPassage) {
    const Schedule schedule = tank_schedule(Interpolation::linear_in_gains);
    const auto step = run_schedule(tank_branch(), schedule, {{0, 10}, {0, 32}}, {.horizon = 200});
    ASSERT_TRUE(step);
    ASSERT_EQ(step->warnings.size(), 1u);
    EXPECT_EQ(step->warnings[0].code, "schedule-coupling");
    const auto slow = run_schedule(tank_branch(), schedule, {{0, 10}, {2000, 32}}, {.horizon = 2000});
    ASSERT_TRUE(slow);
    EXPECT_TRUE(slow->warnings.empty());
}

TEST(ScheduledRun, PassesTheWholeRangeWithLessErrorThanOneSetting) {
    const SteadyBranch branch = tank_branch();
    const Schedule schedule = tank_schedule(Interpolation::linear_in_gains);
    // The setting that the smallest area allows is stable at all levels, but slow.
    const Schedule one = one_row(controller_of(schedule.rows.front()), 10);
    const auto passages = standard_passages(branch, schedule);
    ASSERT_TRUE(passages);
    ASSERT_EQ(passages->size(), 4u);
    for (const Passage& passage : *passages) {
        const auto with = run_schedule(branch, schedule, passage.profile, {.horizon = passage.horizon});
        const auto without = run_schedule(branch, one, passage.profile, {.horizon = passage.horizon});
        ASSERT_TRUE(with && without);
        EXPECT_TRUE(with->ended.empty()) << with->ended;
        EXPECT_TRUE(with->settled) << passage.name;
        // A large step down ends where the smallest area requires low gain, and the schedule is not faster there.
        const double allowed = passage.name == "step down" ? 1.05 : 1.0;
        EXPECT_LT(with->IAE, allowed * without->IAE) << passage.name;
    }
}

TEST(LinearisingRun, IsTheFirstOrderLagOfItsTimeBehindTheDeadTime) {
    NonlinearPlant tank = conical_tank(20);  // another level than at the start: the law begins at the start of the run
    tank.input.min = -1e6;
    tank.input.max = 1e6;
    const auto branch = SteadyBranch::follow({.plant = tank, .along = Along::output, .from = 10, .to = 32});
    ASSERT_TRUE(branch);
    const Schedule schedule = tank_schedule(Interpolation::linear_in_gains);
    const auto passage = run_linearising(*branch, schedule, {{0, 12}, {0, 15}}, {.horizon = 60, .samples = 241});
    ASSERT_TRUE(passage) << passage.error().message;
    // K of the tank is 2 sqrt(h)/c: the slowest row in closed form.
    double tau = 0;
    for (const ScheduleRow& row : schedule.rows) tau = std::max(tau, row.Ti / (row.Kp * 2 * std::sqrt(row.at) / 40));
    EXPECT_NEAR(passage->tau, tau, 1e-6 * tau);
    const double L = 2;
    for (std::size_t k = 0; k < passage->run.t.size(); ++k) {
        const double t = passage->run.t[k];
        EXPECT_NEAR(passage->run.y[k], t < L ? 12 : 15 - 3 * std::exp(-(t - L) / tau), 1e-6) << t;
    }
    EXPECT_NEAR(passage->run.IAE, 3 * (L + tau), 0.01);
    EXPECT_TRUE(passage->run.settled);
}

TEST(LinearisingRun, SaysWhereThereIsNone) {
    const SteadyBranch branch = tank_branch();
    const Schedule schedule = tank_schedule(Interpolation::linear_in_gains);
    const auto ramp = run_linearising(branch, schedule, {{0, 12}, {50, 15}}, {.horizon = 60});
    ASSERT_FALSE(ramp);
    EXPECT_NE(ramp.error().message.find("single steps"), std::string::npos);
    const auto along = SteadyBranch::follow(
        {.plant = conical_tank(20), .along = Along::parameter, .parameter = "c", .from = 30, .to = 50});
    EXPECT_FALSE(run_linearising(*along, schedule, {{0, 30}, {0, 50}}, {.horizon = 60}));
}

TEST(ScheduledRun, AlongAParameterHoldsTheOutputWhileItMoves) {
    const auto branch = SteadyBranch::follow(
        {.plant = conical_tank(20), .along = Along::parameter, .parameter = "c", .from = 30, .to = 50});
    ASSERT_TRUE(branch);
    const IdealPid pid{.Kp = 20, .Ti = 6, .Td = 0.8, .filter = {FilterType::measurement_second_order, 0.08}};
    const auto run = run_schedule(*branch, one_row(pid, 30), {{0, 30}, {50, 50}}, {.horizon = 300});
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_NEAR(run->y.back(), 20, 1e-3);
    EXPECT_NEAR(run->u.back(), 50 * std::sqrt(20), 0.05);
}

TEST(ScheduledRun, RefusesAProfileThatIsNone) {
    const auto refusal = [](const Profile& profile) {
        const auto run = run_schedule(tank_branch(), one_row({.Kp = 1, .Ti = 1}, 10), profile, {.horizon = 1});
        return run ? "" : run.error().message;
    };
    EXPECT_EQ(refusal({}), "The profile has no points.");
    EXPECT_EQ(refusal({{1, 12}, {0, 14}}), "The profile's times must be in ascending order; 0 follows 1.");
}

}  // namespace
}  // namespace tunewright::range
