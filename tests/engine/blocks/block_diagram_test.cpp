// Several loops in one diagram, against the single loop and against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <string>

#include "engine/blocks/diagram_loop.h"
#include "engine/blocks/diagram_response.h"
#include "engine/blocks/diagram_stability.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/structure/cascade_diagram.h"
#include "engine/structure/step_figures.h"
#include "tests/engine/structure/plants.h"

namespace tunewright {
namespace {

using structure::first_order;
using structure::pi;
using structure::transfer;

TEST(BlockDiagram, OneLoopIsTheLoopItself) {
    const LinearPlant plant = transfer({-0.6, 1}, {12, 8, 1}, 3);
    const ParallelPid pid =
        to_parallel(IdealPid{.Kp = 0.8, .Ti = 6, .Td = 1.2, .filter = {FilterType::measurement_second_order, 0.2}});
    BlockDiagram diagram;
    const int y = diagram.add_signal();
    const auto signals = add_pid(diagram, pid, y);
    ASSERT_TRUE(signals);
    diagram.add(signals->output, y, plant);
    const DiagramLoop loop(diagram, signals->output);
    const auto own = Loop::make(plant, pid);
    ASSERT_TRUE(own);
    for (const double omega : {1e-3, 0.02, 0.17, 0.9, 7.0, 80.0}) {
        EXPECT_LT(std::abs(loop.at(omega).S - own->at(omega).S), 1e-12) << omega;
        EXPECT_LT(std::abs(loop.at(omega).T - own->at(omega).T), 1e-12) << omega;
    }
}

TEST(BlockDiagram, TheLoopAtTheValveIsTheProductOfBothLoopsOfACascade) {
    const structure::CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20)};
    const IdealPid inner = pi(1.25, 5), outer = pi(1.04, 60);
    const auto all = structure::cascade_diagram(plants, inner, &outer),
               alone = structure::cascade_diagram(plants, inner, nullptr);
    ASSERT_TRUE(all && alone);
    for (const double omega : {0.003, 0.04, 0.3, 2.0}) {
        const std::complex<double> valve = DiagramLoop(all->diagram, all->valve).at(omega).S,
                                   at_r2 = DiagramLoop(all->diagram, all->r2).at(omega).S,
                                   own = DiagramLoop(alone->diagram, alone->valve).at(omega).S;
        EXPECT_LT(std::abs(valve - own * at_r2), 1e-12) << omega;
    }
}

TEST(BlockDiagram, TheOuterGainOfSeborgsCascadeIsUltimateWhereRouthSaysSo) {
    // 8 s^3 + 46 s^2 + 31 s + 5 + 4 Kc: 46 x 31 = 8 (5 + 4 Kc) at Kc = 43.3125.
    const structure::CascadePlants plants{transfer({1}, {1, 1}), transfer({1}, {8, 6, 1})};
    for (const double Kc : {43.3124, 43.3126}) {
        const IdealPid inner{.Kp = 4}, outer{.Kp = Kc};
        const auto all = structure::cascade_diagram(plants, inner, &outer);
        ASSERT_TRUE(all);
        EXPECT_EQ(count_unstable_poles(all->diagram).unstable_poles, Kc > 43.3125 ? 2 : 0);
        const auto pole = rightmost_pole(all->diagram);
        ASSERT_TRUE(pole);
        EXPECT_EQ(pole->real() > 0, Kc > 43.3125);
        EXPECT_NEAR(std::abs(pole->imag()), std::sqrt(31.0 / 8), 1e-3);
    }
}

/// The two methods agree on whether the loops are stable; both kinds must occur.
void expect_agreement(int cases, const std::function<BlockDiagram(structure::RandomNumbers&)>& make) {
    structure::RandomNumbers random(54);
    int stable = 0;
    for (int i = 0; i < cases; ++i) {
        const BlockDiagram diagram = make(random);
        const bool counted = count_unstable_poles(diagram).stable();
        const auto pole = rightmost_pole(diagram);
        ASSERT_TRUE(pole) << i;
        EXPECT_EQ(counted, pole->real() < 0) << i << ": " << *pole;
        stable += counted;
    }
    EXPECT_GT(stable, cases / 10);
    EXPECT_LT(stable, cases - cases / 10);
}

TEST(DiagramStability, BothMethodsAgreeOnTwoHundredCascades) {
    expect_agreement(200, [](structure::RandomNumbers& random) {
        const double slow = random.log_uniform(1, 30);
        const structure::CascadePlants plants{first_order(1, 1, random.log_uniform(0.05, 2)),
                                              first_order(1, slow, slow * random.log_uniform(0.05, 1))};
        const IdealPid inner = pi(random.log_uniform(0.1, 3), random.log_uniform(0.3, 3)),
                       outer = pi(random.log_uniform(0.1, 5), slow * random.log_uniform(0.3, 2));
        return structure::cascade_diagram(plants, inner, &outer)->diagram;
    });
}

TEST(DiagramStability, BothMethodsAgreeOnTwoHundredPairsOfInteractingLoops) {
    expect_agreement(200, [](structure::RandomNumbers& random) {
        BlockDiagram diagram;
        const int y[] = {diagram.add_signal(), diagram.add_signal()};
        int u[2];
        for (int i = 0; i < 2; ++i)
            u[i] =
                add_pid(diagram, to_parallel(pi(random.log_uniform(0.1, 4), random.log_uniform(0.3, 6))), y[i])->output;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                diagram.add(u[j], y[i],
                            first_order(i == j ? 1 : random.log_uniform(0.1, 1.5) * (i == 0 ? 1 : -1),
                                        random.log_uniform(1, 8), random.log_uniform(0.1, 3)));
        return diagram;
    });
}

TEST(DiagramResponse, ALoopWithIntegralActionHasTheIntegralErrorOfItsTiOverKp) {
    BlockDiagram diagram;
    const int y = diagram.add_signal();
    const auto signals = add_pid(diagram, to_parallel(pi(0.6, 9)), y);
    diagram.add(signals->output, y, first_order(2, 10, 3));
    const auto figures = structure::step_figures(diagram, signals->output, y, signals->output, 0);
    ASSERT_TRUE(figures);
    EXPECT_NEAR(*figures->IE, -15, 1e-6);
    EXPECT_TRUE(figures->settles);
}

TEST(DiagramResponse, APlantAloneRespondsAsItsClosedForm) {
    BlockDiagram diagram;
    const int u = diagram.add_signal(), y = diagram.add_signal();
    diagram.add(u, y, first_order(2, 5, 1.5));
    const auto response = DiagramResponse::of(diagram, {{u, 1}}, {.horizon = 20});
    ASSERT_TRUE(response);
    for (const ResponseNode& node : response->pair(y, u, 0).nodes)
        EXPECT_NEAR(node.y, node.t <= 1.5 ? 0 : 2 * (1 - std::exp(-(node.t - 1.5) / 5)), 1e-9) << node.t;
}

TEST(DiagramResponse, IntegratorsAndGainsAloneComeToRest) {
    // 1/(A s) with proportional action: y = (1 - exp(-Kc t/A))/Kc, in any unit of time.
    for (const double area : {1e-6, 3.0, 1e7}) {
        BlockDiagram diagram;
        const int y = diagram.add_signal();
        const auto signals = add_pid(diagram, to_parallel(IdealPid{.Kp = 2}), y);
        diagram.add(signals->output, y, *LinearPlant::make(Plant(Zpk{.K = 1 / area, .zeros = {}, .poles = {0.0}})));
        ASSERT_TRUE(count_unstable_poles(diagram).stable());
        const auto response = DiagramResponse::of(diagram, {{signals->output, 1}}, {});
        ASSERT_TRUE(response);
        ASSERT_TRUE(response->settles());
        const double T = area / 2;
        const auto values = response->sampled(y, {0, T, 3 * T, 1e3 * T});
        for (const auto& [at, value] :
             {std::pair{0.0, values[0]}, {1.0, values[1]}, {3.0, values[2]}, {1e3, values[3]}})
            EXPECT_NEAR(value, 0.5 * (1 - std::exp(-at)), 1e-5) << area << " " << at;
    }
}

TEST(DiagramResponse, AShortDisturbanceThatArrivesAfterALongDeadTimeIsFollowed) {
    // A bump of width 1 is over long before it arrives 100 later, when steps have become long:
    // y = 0.4/((s + 1)(s + 2)^2 (s + 0.1)) e^(-100s), by partial fractions.
    BlockDiagram diagram;
    const int u = diagram.add_signal(), bump = diagram.add_signal(), y = diagram.add_signal();
    diagram.add(u, bump, transfer({1, 0}, {0.25, 1.25, 2, 1}));
    diagram.add(bump, y, first_order(1, 10, 100));
    const auto response = DiagramResponse::of(diagram, {{u, 1}}, {});
    ASSERT_TRUE(response);
    const auto expected = [](double t) {
        return t < 0 ? 0
                     : -4.0 / 9 * std::exp(-t) + 0.4 / 3.249 * std::exp(-0.1 * t) +
                           (1.16 / 3.61 + 0.4 / 1.9 * t) * std::exp(-2 * t);
    };
    const auto nodes = response->pair(y, u, 0).nodes;
    EXPECT_GT(nodes.back().t, 180);
    for (const ResponseNode& node : nodes) EXPECT_NEAR(node.y, expected(node.t - 100), 1e-6) << node.t;
}

TEST(DiagramResponse, ASignalThatIsOnlyRoundingCostsNoSteps) {
    // Two equal paths of opposite signs: y is 0 but for rounding, which no step can follow.
    BlockDiagram diagram;
    const int u = diagram.add_signal(), y = diagram.add_signal();
    diagram.add(u, y, first_order(2, 10, 1));
    diagram.add(u, y, transfer({-2}, {10, 1}, 1));
    diagram.add(u, y, transfer({0.3}, {60, 23, 1}, 2));
    diagram.add(u, y, transfer({-0.1}, {20, 23.0 / 3, 1.0 / 3}, 2));
    const auto response = DiagramResponse::of(diagram, {{u, 1}}, {});
    ASSERT_TRUE(response);
    const auto nodes = response->pair(y, u, 0).nodes;
    EXPECT_LT(nodes.size(), 1000u);
    for (const ResponseNode& node : nodes) EXPECT_NEAR(node.y, 0, 1e-12);
}

TEST(DiagramResponse, ARunThatIsAskedForMoreThanRoundingEnds) {
    // The values at rest are known to about 1e-11. A run that is to come nearer must neither go on until its steps
    // leave the numbers, nor call that a rest.
    for (const double lag : {0.3, 2.0, 40.0, 900.0})
        for (const double L : {0.0, 0.5, 20.0})
            for (const double settled : {1e-10, 1e-13, 0.0}) {
                SCOPED_TRACE(std::to_string(lag) + " " + std::to_string(L) + " " + std::to_string(settled));
                const LinearPlant plant = transfer({1.5}, {lag * 0.4 * L, lag + 0.4 * L, 1}, L);
                const double gain = 0.3 * (lag + 0.4 * L) / (1.5 * (L + 0.1 * lag));
                const ParallelPid pid = to_parallel(IdealPid{.Kp = gain, .Ti = lag + L});
                BlockDiagram diagram;
                const int y = diagram.add_signal();
                const auto signals = add_pid(diagram, pid, y);
                ASSERT_TRUE(signals);
                diagram.add(signals->output, y, plant);
                ASSERT_TRUE(count_unstable_poles(diagram).stable());
                const auto response = DiagramResponse::of(
                    diagram, {{signals->output, 1}}, {.tolerance = 1e-10, .settled = settled, .max_steps = 200000});
                ASSERT_TRUE(response);
                EXPECT_TRUE(response->settles() || settled < 1e-10);
                EXPECT_LT(response->end(), 1e10);
                double largest = 0;
                const auto nodes = response->pair(y, signals->output, 0).nodes;
                for (const ResponseNode& node : nodes) {
                    ASSERT_TRUE(std::isfinite(node.y) && std::isfinite(node.u) && std::isfinite(node.t));
                    largest = std::max(largest, std::abs(node.y));
                }
                EXPECT_LT(largest, 1.5 * 1.01);
                EXPECT_LT(std::abs(nodes.back().y), 1e-9 * largest);
                EXPECT_NEAR(nodes.back().error_integral, -(lag + L) / gain, 1e-6 * (lag + L) / gain);
            }
}

TEST(DiagramResponse, ALoopFarFasterThanTheOthersCostsNoShortSteps) {
    // The inner loop's dead time is a hundredth of the outer one: once it has settled, steps are far longer than it.
    for (const auto& [L, longest] : {std::pair{0.02, 2.3}, {0.12, 74.0}, {0.3, 3.0}}) {
        const structure::CascadePlants plants{first_order(1.5, 25 * L, L), first_order(2, 2 * longest, longest)};
        const IdealPid inner = pi(6, 8 * L), outer = pi(0.35, 2 * longest);
        const auto all = structure::cascade_diagram(plants, inner, &outer);
        ASSERT_TRUE(all && count_unstable_poles(all->diagram).stable());
        for (const int enters : {all->valve, all->outer_input}) {
            const auto usual = DiagramResponse::of(all->diagram, {{enters, 1}}, {}),
                       fine = DiagramResponse::of(all->diagram, {{enters, 1}}, {.tolerance = 1e-9, .settled = 1e-7});
            ASSERT_TRUE(usual && fine);
            const auto nodes = usual->pair(all->y1, all->valve, 0).nodes;
            EXPECT_LT(nodes.size(), 1200u);
            EXPECT_GT(nodes.back().t, 10 * longest);
            double largest = 0;
            std::vector<double> times;
            for (const ResponseNode& node : nodes) {
                largest = std::max(largest, std::abs(node.y));
                times.push_back(node.t);
            }
            const auto values = fine->sampled(all->y1, times);
            for (std::size_t i = 0; i < times.size(); ++i)
                EXPECT_NEAR(nodes[i].y, values[i], 3e-5 * largest) << times[i];
            const auto figures = structure::step_figures(all->diagram, enters, all->y1, all->valve, 0);
            ASSERT_TRUE(figures);
            EXPECT_NEAR(*figures->IE, enters == all->valve ? 0 : -outer.Ti / outer.Kp, 1e-6 * outer.Ti / outer.Kp);
        }
    }
}

TEST(DiagramStability, DirectTermsBehindDeadTimesAreCounted) {
    // C = Kp (1 + 1/(s Ti)) on a pure dead time: 1 + Kp e^(-Ls) has all zeros left of the axis for Kp < 1 alone.
    for (const auto& [Kp, stable] : {std::pair{0.2, true}, {0.45, true}, {0.7, true}, {1.1, false}}) {
        for (const double lag : {0.0, 1e-3}) {
            BlockDiagram diagram;
            const int y = diagram.add_signal();
            const auto signals = add_pid(diagram, to_parallel(pi(Kp, 60)), y);
            diagram.add(signals->output, y, first_order(1, lag, 15));
            EXPECT_EQ(count_unstable_poles(diagram).stable(), stable) << Kp << " " << lag;
        }
    }
}

TEST(BlockDiagram, ADerivativeWithoutFilterIsRefused) {
    BlockDiagram diagram;
    const int y = diagram.add_signal();
    const auto signals = add_pid(diagram, to_parallel(IdealPid{.Kp = 1, .Ti = 5, .Td = 1}), y);
    ASSERT_FALSE(signals);
    EXPECT_EQ(signals.error().where, "controller");
}

}  // namespace
}  // namespace tunewright
