// Simultaneous runs compared with separate ones, at the same instants.
#include "engine/simulation/linear/neighbouring_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/loop/loop.h"
#include "engine/loop/stability.h"
#include "engine/simulation/linear/indices.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

constexpr double kNeighbourMoved = 1e-5;  // of a parameter, like the step of a gradient
constexpr double kNeighbourAlike = 1e-9;  // of the IAE: the gradient is right to 1e-4

struct StableLoop {
    LinearPlant plant;
    IdealPid pid;
    StepInputs in;
};

/// Stable loops on the given kind of plant, with P, I and D in all proportions.
std::vector<StableLoop> stable_loops(bool resonant, bool with_dead_time, int wanted) {
    std::vector<StableLoop> cases;
    for (std::uint64_t seed = 1; static_cast<int>(cases.size()) < wanted && seed < 2000; ++seed) {
        auto random = test::Random(seed + 7777);
        Zpk zpk = test::random_plant(seed, resonant).plant;
        if (!with_dead_time) zpk.L = 0;
        if (with_dead_time && zpk.L == 0) continue;
        auto plant = LinearPlant::make(zpk);
        if (!plant) continue;
        const double time = plant->time_scale(), gain = std::abs(plant->low_frequency_gain());
        IdealPid pid{.Kp = random.log_uniform(0.05, 1) / gain,
                     .Ti = random.log_uniform(0.2, 2) * time,
                     .Td = random.log_uniform(0.02, 0.5) * time};
        pid.filter = {FilterType::measurement_second_order, pid.Td / 10};
        const auto loop = Loop::make(*plant, to_parallel(pid));
        if (!loop || !count_unstable_poles(*loop).stable()) continue;
        const bool setpoint = random.one_in(2);
        cases.push_back({*plant, pid, {setpoint ? 1.0 : 0.0, setpoint ? 0.0 : 1.0}});
    }
    return cases;
}

std::vector<ParallelPid> neighbours_of(const IdealPid& pid) {
    std::vector<ParallelPid> all;
    for (int i = 0; i < 3; ++i) {
        IdealPid moved = pid;
        (i == 0 ? moved.Kp : i == 1 ? moved.Ti : moved.Td) *= 1 + kNeighbourMoved;
        if (i == 2) moved.filter.Tf *= 1 + kNeighbourMoved;
        all.push_back(to_parallel(moved));
    }
    return all;
}

StepResponse repeatable_run(const StableLoop& c, const ParallelPid& controller, const StepSchedule* repeat) {
    ResponseOptions options;
    options.tolerance = 3e-4;
    options.settled = 1e-4;
    options.max_steps = 5000;
    options.repeat = repeat;
    return simulate_linear(c.plant, controller, c.in, options);
}

double iae_of_run(const StableLoop& c, const StepResponse& run) {
    return integral_of_absolute_error(run.nodes, c.in.r, run.error_integral_final);
}

struct PlantKind {
    bool resonant, with_dead_time;
};

class NeighbouringRuns : public testing::TestWithParam<PlantKind> {};

TEST_P(NeighbouringRuns, AreWhatEachIsByItself) {
    const auto cases = stable_loops(GetParam().resonant, GetParam().with_dead_time, 60);
    ASSERT_EQ(cases.size(), 60u);
    int together = 0;
    for (const auto& c : cases) {
        const StepResponse run = repeatable_run(c, to_parallel(c.pid), nullptr);
        if (!run.settles) continue;
        const auto controllers = neighbours_of(c.pid);
        const auto iaes = neighbouring_iaes(c.plant, controllers, c.in, run);
        if (!iaes) continue;
        ++together;
        const double IAE = iae_of_run(c, run);
        for (std::size_t i = 0; i < controllers.size(); ++i) {
            const double alone = iae_of_run(c, repeatable_run(c, controllers[i], &run.schedule));
            EXPECT_NEAR((*iaes)[i], alone, kNeighbourAlike * IAE) << i << " of Kp " << c.pid.Kp << ", Ti " << c.pid.Ti;
        }
    }
    EXPECT_GT(together, 50);
}

TEST_P(NeighbouringRuns, EveryKindOfRegisterGivesTheSameDigits) {
    if (widest_registers() == Registers::common) GTEST_SKIP() << "this processor has no AVX2: run it on one that has";
    for (const auto& c : stable_loops(GetParam().resonant, GetParam().with_dead_time, 20)) {
        const StepResponse run = repeatable_run(c, to_parallel(c.pid), nullptr);
        const auto controllers = neighbours_of(c.pid);
        const auto common = neighbouring_iaes(c.plant, controllers, c.in, run, Registers::common);
        EXPECT_EQ(common, neighbouring_iaes(c.plant, controllers, c.in, run, Registers::avx2));
    }
}

INSTANTIATE_TEST_SUITE_P(Plants, NeighbouringRuns,
                         testing::Values(PlantKind{false, true}, PlantKind{true, true}, PlantKind{false, false},
                                         PlantKind{true, false}));

TEST(NeighbouringRuns, EndWhereTheRunDid) {
    // With its own end rule the loop with a slightly higher gain would end one oscillation earlier, and its IAE would
    // lack that oscillation: the derivative by Kp was -1.40 instead of -0.55.
    const std::complex<double> mode(-0.28306572049552803, 0.63627834119853499);
    const auto plant = LinearPlant::make(Zpk{.K = 15.347451304062645,
                                             .zeros = {},
                                             .poles = {-3.808328648913363, mode, std::conj(mode)},
                                             .L = 0.92949073905550383});
    IdealPid pid{.Kp = 0.0650919909118493, .Ti = 1.67993201458303, .Td = 1.83409706643009};
    pid.filter = {FilterType::measurement_second_order, pid.Td / 10};
    const StableLoop loop{*plant, pid, {0, 1}};
    const StepResponse run = repeatable_run(loop, to_parallel(pid), nullptr);
    const auto controllers = neighbours_of(pid);
    const auto iaes = neighbouring_iaes(*plant, controllers, loop.in, run);
    ASSERT_TRUE(iaes);
    ResponseOptions exact;
    exact.tolerance = 1e-8;
    exact.settled = 1e-9;
    const auto exact_iae = [&](const ParallelPid& c) {
        return iae_of_run(loop, simulate_linear(*plant, c, loop.in, exact));
    };
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        const double derivative = ((*iaes)[i] / iae_of_run(loop, run) - 1) / kNeighbourMoved;
        const double expected = (exact_iae(controllers[i]) / exact_iae(to_parallel(pid)) - 1) / kNeighbourMoved;
        EXPECT_NEAR(derivative, expected, 1e-3) << i;
    }
}

TEST(NeighbouringRuns, WhatTheyCannotRepeatIsLeftToRunsOfTheirOwn) {
    const auto plant = LinearPlant::make(Fopdt{.K = 1, .T = 2, .L = 1});
    const std::vector<ParallelPid> pi = {to_parallel(IdealPid{.Kp = 0.5, .Ti = 2})};
    const std::vector<ParallelPid> p = {{.Kp = 0.5}};
    const StepInputs load{0, 1};
    ResponseOptions to_10;
    to_10.horizon = 10;
    EXPECT_TRUE(neighbouring_iaes(*plant, pi, load, simulate_linear(*plant, pi[0], load, {})));
    EXPECT_FALSE(neighbouring_iaes(*plant, pi, load, simulate_linear(*plant, pi[0], load, to_10)));
    EXPECT_FALSE(neighbouring_iaes(*plant, p, load, simulate_linear(*plant, p[0], load, {})));
}

}  // namespace
}  // namespace tunewright
