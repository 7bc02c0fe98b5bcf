// The search `fast` compared with the best design that other searches find, and with the same problem in other units.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "engine/tuning/robust/known_start.h"
#include "engine/tuning/robust/search.h"
#include "tests/engine/tuning/best_known_design.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright::test {
namespace {

constexpr double kAllowed = 1e-3;  // relative difference of the cost

Zpk lightly_damped() { return {.K = 9, .zeros = {}, .poles = {{-0.24, 3}, {-0.24, -3}, -1.0}, .L = 0.2}; }

/// False: neither search finds a controller.
bool expect_best_known(const DesignTask& task, int random_starts, std::uint64_t seed, const std::string& name) {
    const LinearPlant linear = *LinearPlant::make(task.plant);
    const auto fast = designed(task, "fast"), simplex = designed(task, "nelder_mead");
    EXPECT_TRUE(fast || !simplex) << name;
    if (!fast) return false;
    robust::DesignProblem problem = problem_of(task, linear, fast->controller);
    set_reference_optima(task, problem);
    const auto cost = checked_cost(problem, point_of(fast->controller));
    EXPECT_TRUE(cost.has_value()) << name << " exceeds a limit";
    const auto best = best_from_random_starts(problem, random_starts, seed);
    const auto other = simplex ? checked_cost(problem, point_of(simplex->controller)) : std::nullopt;
    EXPECT_TRUE(best || other) << name << ": nothing to compare with";
    EXPECT_LE(cost.value_or(INFINITY), std::min(best.value_or(INFINITY), other.value_or(INFINITY)) * (1 + kAllowed))
        << name;
    return true;
}

// Its smallest Td is a local optimum: 2.10478, compared with 2.07482 at Td = 0.239.
TEST(RobustSearch, TheLeastTdIsNoAnswerWithoutALookElsewhere) {
    const DesignTask task{lightly_damped(), 1.5, "load_iae"};
    const auto fast = designed(task, "fast");
    ASSERT_TRUE(fast.has_value());
    EXPECT_NEAR(fast->controller.Td, 0.239, 0.01);
    EXPECT_TRUE(expect_best_known(task, 20, 1, "load"));
    EXPECT_TRUE(expect_best_known({lightly_damped(), 1.5, "setpoint_iae"}, 20, 1, "set point"));
}

// A search over Kp and Ti has no curvature for Td; with zeros there the next search could take no step.
TEST(RobustSearch, TheCurvatureThatAPiHandsOnServesAPid) {
    const DesignTask task{Fopdt{2, 10, 3}, 1.4, "load_iae"};
    const LinearPlant linear = *LinearPlant::make(task.plant);
    const auto best = designed(task, "fast");
    ASSERT_TRUE(best.has_value());
    const robust::DesignProblem pid = problem_of(task, linear, best->controller);
    robust::DesignProblem pi = pid;
    pi.pid = false;
    const auto found = robust::minimise(robust::Sweep(pi, robust::reference_frequency(pi)), pi,
                                        {std::log(0.3), std::log(8), std::log(0.5)}, {}, {});
    ASSERT_TRUE(found.curvature);
    robust::SqpOptions options;
    options.curvature = found.curvature;
    const auto next = robust::minimise(robust::Sweep(pid, robust::reference_frequency(pid)), pid,
                                       {found.x[0], found.x[1], std::log(0.5)}, options, {});
    EXPECT_TRUE(next.converged);
    EXPECT_NEAR(next.log_cost, robust::log_cost(pid, point_of(best->controller), 1e-6), 1e-3);
}

// With a second member that is the same plant, the problem is the same, but its optimum is not known beforehand: the
// whole search, with its scans, is the judge of the table of starts.
TEST(RobustSearch, AKnownStartLeadsToTheOptimumOfTheWholeSearch) {
    Random random(11);
    for (int i = 0; i < 120; ++i) {
        const double K = random.log_uniform(0.01, 100), T = random.log_uniform(0.1, 100);
        const double L = T * random.log_uniform(std::exp(-2.99), std::exp(2.99));
        const LinearPlant plant = *LinearPlant::make(Fopdt{.K = K, .T = T, .L = L});
        robust::DesignProblem problem;
        problem.plant = &plant;
        problem.pid = !random.one_in(3);
        if (problem.pid) problem.filter.Tf_over_Td = random.one_in(3) ? random.uniform(0.05, 0.3) : 0.1;
        problem.limits.Ms = random.one_in(3) ? 1.4 : random.uniform(1.16, 2.4);
        problem.limits.Mt = random.one_in(2) ? problem.limits.Ms : random.uniform(1.1, 2.4);
        ASSERT_TRUE(robust::known_start(problem));
        robust::DesignProblem whole = problem;
        const std::vector<LinearPlant> same{plant};
        whole.others = same;
        ASSERT_FALSE(robust::known_start(whole));
        const auto quick = robust::fast_search({problem, robust::reference_frequency(problem)}, problem, {});
        const auto full = robust::fast_search({whole, robust::reference_frequency(whole)}, whole, {});
        ASSERT_TRUE(quick && full);
        EXPECT_NEAR(quick->log_cost, full->log_cost, 5e-5)
            << "L/T " << L / T << ", Ms " << problem.limits.Ms << ", Mt " << problem.limits.Mt;
    }
}

TEST(RobustSearch, FastIsWithinAThousandthOfTheBestKnown) {
    int compared = 0;
    for (int i = 1000; i < 1018; ++i) {
        const RandomPlant drawn = random_plant(static_cast<std::uint64_t>(i), i % 3 == 0);
        compared += expect_best_known({drawn.plant, drawn.M, i % 2 == 0 ? "load_iae" : "setpoint_iae"}, 8,
                                      static_cast<std::uint64_t>(i), drawn.description);
    }
    EXPECT_GE(compared, 15) << "the others have no controller within the limits";
}

// An integrator, a slow lag and little dead time: the phase is near -180 degrees for decades below the phase crossover.
// With a limit of 1.2 the bandwidth is a hundred times below it; a search only around the crossover found 5261, and
// with 1.224 nothing.
TEST(RobustSearch, ALoopFarBelowThePhaseCrossoverIsFound) {
    const Plant plant = Zpk{.K = 3.03251, .zeros = {-8.17802521}, .poles = {0.0, -0.115633297}, .L = 0.0440133};
    const LinearPlant linear = *LinearPlant::make(plant);
    for (const auto& [M, known] : {std::pair{1.15, 7918.2}, {1.2, 1005.52}, {1.2239, 247.917}, {1.4, 8.95365}}) {
        const auto fast = designed({plant, M}, "fast");
        ASSERT_TRUE(fast) << M;
        const auto problem = problem_of({plant, M}, linear, fast->controller);
        EXPECT_LE(checked_cost(problem, point_of(fast->controller)).value_or(INFINITY), known * (1 + kAllowed)) << M;
    }
}

// Two integrators with lags leave a PID little phase: far below the lags it reaches any allowed Ms and Mt.
TEST(RobustSearch, BehindTwoIntegratorsALoopSlowEnoughIsFound) {
    for (const Zpk& plant : {Zpk{.K = 1, .zeros = {}, .poles = {0.0, 0.0, -0.0561, -0.0156, -0.035}, .L = 2.3},
                             Zpk{.K = 1, .zeros = {4.86}, .poles = {0.0, 0.0, -18.3, -0.0681, -23.4}, .L = 0.037},
                             Zpk{.K = 1, .zeros = {}, .poles = {0.0, 0.0}, .L = 0.054}}) {
        const DesignTask task{plant, 1.4};
        const LinearPlant linear = *LinearPlant::make(task.plant);
        const auto fast = designed(task, "fast");
        ASSERT_TRUE(fast) << fast.error().message;
        robust::DesignProblem problem = problem_of(task, linear, fast->controller);
        const double cost = checked_cost(problem, point_of(fast->controller)).value_or(INFINITY);
        for (const double slower : {0.1, 0.01, 1e-3}) {
            problem.reference = slower * robust::reference_frequency(problem_of(task, linear, fast->controller));
            EXPECT_LE(cost, best_from_random_starts(problem, 8, 1).value_or(INFINITY) * (1 + kAllowed)) << slower;
        }
    }
}

// For a lead slower than the loop the best filter is slower than the lead: without a search there the cost was 1.23
// times as high.
TEST(RobustSearch, AFilterBelowASlowZeroIsFound) {
    const DesignTask task{Zpk{.K = 1, .zeros = {-0.0518}, .poles = {-1.55, -1.18, -16.9}, .L = 1.92707}, 1.357};
    const LinearPlant linear = *LinearPlant::make(task.plant);
    const auto fast = designed(task, "fast");
    ASSERT_TRUE(fast.has_value());
    robust::DesignProblem problem = problem_of(task, linear, fast->controller);
    const double cost = checked_cost(problem, point_of(fast->controller)).value_or(INFINITY);
    problem.reference = 0.03 * robust::reference_frequency(problem);
    EXPECT_LE(cost, best_from_random_starts(problem, 20, 1).value_or(0) * (1 + kAllowed));
}

/// K/(s (s^2 + 2 zeta s + 1)) e^(-Ls): only the resonance limits its gain. A loop far below the resonance is not
/// affected by it, and a filter between the two reduces it.
Plant integrator_with_resonance(double zeta, double L) {
    return TransferFunction{.num = {1}, .den = {1, 2 * zeta, 1, 0}, .L = L};
}

TEST(RobustSearch, ABarelyDampedResonanceBehindAnIntegratorIsStayedFarBelow) {
    for (const auto& [zeta, L, M] : {std::tuple{7e-3, 0.1, 1.2}, {5.4e-3, 0.0, 1.1}, {3.3e-3, 1.0, 1.1}}) {
        const DesignTask task{integrator_with_resonance(zeta, L), M};
        const LinearPlant linear = *LinearPlant::make(task.plant);
        const auto fast = designed(task, "fast");
        ASSERT_TRUE(fast) << fast.error().message;
        robust::DesignProblem problem = problem_of(task, linear, fast->controller);
        const double cost = checked_cost(problem, point_of(fast->controller)).value_or(INFINITY);
        for (const double reference : {1.0, 0.1, 0.03, 0.01, 1e-3}) {
            problem.reference = reference;
            EXPECT_LE(cost, best_from_random_starts(problem, 8, 1).value_or(INFINITY) * (1 + kAllowed)) << reference;
        }
    }
}

TEST(RobustSearch, NoResonanceIsTooLightlyDampedForAnAnswer) {
    Random random(1);
    for (int i = 0; i < 12; ++i) {
        const DesignTask task{integrator_with_resonance(random.log_uniform(1e-4, 1e-2), random.uniform(0, 2)),
                              random.uniform(1.1, 1.6)};
        const auto fast = designed(task, "fast");
        ASSERT_TRUE(fast) << fast.error().message;
        const LinearPlant linear = *LinearPlant::make(task.plant);
        const robust::DesignProblem problem = problem_of(task, linear, fast->controller);
        EXPECT_LT(robust::excess_on(linear, problem, point_of(fast->controller), {.step = 0.05, .density = 60}), 2e-5);
    }
}

/// `fast` costs at most as much as `known`, a design within the limits whose filter follows the same rule.
void expect_no_costlier_than(const IdealPid& known, const DesignTask& task) {
    const LinearPlant linear = *LinearPlant::make(task.plant);
    const auto fast = designed(task, "fast");
    ASSERT_TRUE(fast.has_value());
    const robust::DesignProblem problem = problem_of(task, linear, fast->controller);
    const auto other = checked_cost(problem, point_of(known)), cost = checked_cost(problem, point_of(fast->controller));
    ASSERT_TRUE(other.has_value() && cost.has_value());
    EXPECT_LE(*cost, *other * (1 + kAllowed));
}

// Near Td = 1.8 and beyond Ti = 100 of the loop's own times the gain is 20 times that of the surrounding region.
TEST(RobustSearch, ASmallIslandOfHighGainIsFound) {
    const RandomPlant drawn = random_plant(159, true);
    const DesignTask task{drawn.plant, drawn.M, "load_iae"};
    const auto grid = designed(task, "grid");
    ASSERT_TRUE(grid.has_value());
    expect_no_costlier_than(grid->controller, task);
}

// Kp and Td have an effect here only through Ki and the filter.
TEST(RobustSearch, AnIntegralAloneBehindAHeavyFilterIsFound) {
    const RandomPlant drawn = random_plant(2070, true);
    const LinearPlant linear = *LinearPlant::make(drawn.plant);
    robust::DesignProblem problem;
    problem.plant = &linear;
    const double unit = 1 / robust::reference_frequency(problem);
    IdealPid known;
    known.Kp = 5.77e-6;
    known.Ti = 6.27e-5 * unit;
    known.Td = 237.6 * unit;
    expect_no_costlier_than(known, {drawn.plant, drawn.M, "load_iae"});
}

// Plants for which a search from one start ended 0.2 to 140 % above the best: with an integral behind a heavy filter
// (27, 195, 246, 294), with a Td too short to matter (96, 357), with a Ti of hundreds of the loop's own times (399,
// 492), on a kink of the set-point error (139, 164, 2227, 2270, 2285) or of a resonant load's (1170), and beyond the
// frequency grid (459); and plants whose weighted optimum is near the optimum of one part, while others were searched
// (137, 156, 264).
TEST(RobustSearch, PlantsWithSeveralValleysEndInTheCheapest) {
    struct Case {
        std::uint64_t plant;
        bool resonant;
        const char* objective;
    };
    for (const auto& [plant, resonant, objective] :
         {Case{27, true, "load_iae"}, Case{96, true, "load_iae"}, Case{195, true, "load_iae"},
          Case{246, true, "load_iae"}, Case{294, true, "load_iae"}, Case{357, true, "load_iae"},
          Case{399, true, "setpoint_iae"}, Case{492, true, "setpoint_iae"}, Case{139, false, "setpoint_iae"},
          Case{164, false, "setpoint_iae"}, Case{2227, false, "setpoint_iae"}, Case{2270, false, "setpoint_iae"},
          Case{2285, false, "setpoint_iae"}, Case{1170, true, "load_iae"}, Case{459, true, "load_ie"},
          Case{137, false, "weighted"}, Case{156, true, "weighted"}, Case{264, true, "weighted"}}) {
        const RandomPlant drawn = random_plant(plant, resonant);
        EXPECT_TRUE(
            expect_best_known({drawn.plant, drawn.M, objective}, 20, plant, drawn.description + ", " + objective));
    }
}

Zpk in_other_units(Zpk plant, double time, double gain) {
    for (auto& pole : plant.poles) pole /= time;
    for (auto& zero : plant.zeros) zero /= time;
    plant.L *= time;
    plant.K *= gain * std::pow(time, static_cast<double>(plant.zeros.size()) - static_cast<double>(plant.poles.size()));
    return plant;
}

// The objective without simulations shows that the search itself is independent of both units.
TEST(RobustSearch, UnitsOfTimeAndGainChangeNothing) {
    for (const std::uint64_t seed : {3, 7, 12, 20}) {
        const RandomPlant drawn = random_plant(seed, seed % 3 == 0);
        const auto base = designed({drawn.plant, drawn.M, "load_ie"}, "fast");
        ASSERT_TRUE(base.has_value());
        const IdealPid& p = base->controller;
        for (const double time : {1e-9, 1e-4, 1e9})
            for (const double gain : {1e-9, -3e5, 1e9}) {
                const auto other = designed({in_other_units(drawn.plant, time, gain), drawn.M, "load_ie"}, "fast");
                ASSERT_TRUE(other.has_value()) << seed << ": " << other.error().message;
                const IdealPid& q = other->controller;
                EXPECT_NEAR(q.Ti / q.Kp / (p.Ti / p.Kp) / time / gain, 1, 1e-6) << seed << " " << time << " " << gain;
                EXPECT_NEAR(q.Kp * gain / p.Kp, 1, 1e-3) << seed << " " << time << " " << gain;
                EXPECT_NEAR(q.Ti / time / p.Ti, 1, 1e-3) << seed << " " << time << " " << gain;
                EXPECT_NEAR(q.Td / time / p.Td, 1, 1e-3) << seed << " " << time << " " << gain;
            }
    }
}

TEST(RobustSearch, TheBoundIsNeverAboveTheCost) {
    using namespace robust;
    for (const std::uint64_t seed : {1, 5, 6, 9, 14}) {
        const RandomPlant drawn = random_plant(seed, seed % 3 == 0);
        for (const char* objective : {"load_iae", "setpoint_iae", "weighted"}) {
            const DesignTask task{drawn.plant, drawn.M, objective};
            const auto fast = designed(task, "fast");
            ASSERT_TRUE(fast.has_value()) << seed;
            const LinearPlant linear = *LinearPlant::make(drawn.plant);
            const DesignProblem problem = problem_of(task, linear, fast->controller);
            const Sweep sweep(problem, reference_frequency(problem));
            int looked_at = 0;
            for (const auto& point : scan(sweep)) {
                const double cost = log_cost(problem, point.x, 1e-5);
                if (!std::isfinite(cost)) continue;
                EXPECT_LE(log_cost_bound(problem, point.x), cost + 1e-5) << seed << " " << objective;
                ++looked_at;
            }
            EXPECT_GT(looked_at, 5) << seed;
        }
    }
}

}  // namespace
}  // namespace tunewright::test
