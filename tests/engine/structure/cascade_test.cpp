// Cascades: published settings recomputed, identities, and designs within their limits.
#include "engine/structure/cascade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/blocks/diagram_loop.h"
#include "engine/structure/cascade_diagram.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Cascade, MathWorksSettingsHaveThePhaseMarginsOfTheirSpecification) {
    // MathWorks, Designing Cascade Control System with PI Controllers: 60 degrees in each loop.
    const CascadePlants plants{transfer({3}, {1, 2}), transfer({10}, {1, 3, 3, 1})};
    const auto figures = judge_cascade(plants, {pi(0.244, 0.134), pi(0.015, 0.716)});
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->outer_margins.phase_margin / kDegree, 60, 0.01);
    const auto alone = cascade_diagram(plants, pi(0.244, 0.134), nullptr);
    const DiagramLoop inner(alone->diagram, alone->valve);
    EXPECT_NEAR(find_margins(inner, make_loop_grid(inner)).phase_margin / kDegree, 60, 0.01);
    // Recomputed by Fourier inversion and by the method of steps in another program.
    EXPECT_NEAR(figures->Ms_inner, 1.212758106, 1e-6);
    EXPECT_NEAR(figures->Ms_outer, 1.496802263, 1e-6);
    EXPECT_NEAR(figures->Ms_valve, 1.209578347, 1e-6);
    EXPECT_NEAR(*figures->inner_load.IAE, 9.049934601, 2e-4 * 9.05);
    EXPECT_NEAR(*figures->outer_load.IAE, 54.81374720, 2e-4 * 54.8);
}

TEST(Cascade, ThePeaksOfSkogestadAndPostlethwaitesExerciseAreThoseOfAnIndependentProgram) {
    const CascadePlants plants{transfer({1}, {2.4, 6.4, 1}), transfer({-0.6, 1}, {6, 1}, 1)};
    const auto figures = judge_cascade(plants, {pi(15.5, 1.6), pi(1.0 / 0.6, 6)});
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->Ms_inner, 1.746, 5e-4);
    EXPECT_NEAR(figures->Ms_outer, 1.852, 5e-4);
    EXPECT_NEAR(figures->Ms_valve, 1.666, 5e-4);
    EXPECT_NEAR(*figures->inner_load.IAE, 0.0789, 1e-4);
}

TEST(Cascade, IntegralErrorsFollowFromTheSettingsAlone) {
    const CascadePlants plants{first_order(0.8, 5, 2), first_order(1.2, 60, 20)};
    const auto both = judge_cascade(plants, {pi(1.1, 6), pi(0.9, 70)});
    ASSERT_TRUE(both && both->stable);
    EXPECT_NEAR(*both->outer_load.IE, -70 / 0.9, 1e-9 * *both->outer_load.IAE);
    EXPECT_NEAR(*both->inner_load.IE, 0, 1e-9 * *both->inner_load.IAE);

    const auto proportional = judge_cascade(plants, {{.Kp = 1.4}, pi(0.9, 70)});
    ASSERT_TRUE(proportional && proportional->stable);
    EXPECT_NEAR(*proportional->outer_load.IE, -70 / 0.9 * (1 + 1 / (1.4 * 0.8)), 1e-9 * *proportional->outer_load.IAE);
    EXPECT_NEAR(*proportional->inner_load.IE, -70 / (0.9 * 1.4), 1e-9 * *proportional->inner_load.IAE);
}

TEST(Cascade, AstromAndHagglundsExampleHasItsExactIntegral) {
    // Astrom and Hagglund (1995), section 7.2; y does not change its sign after the inner load.
    const CascadePlants plants{transfer({1}, {1, 1}), transfer({1}, {1, 3, 3, 1})};
    const auto figures = judge_cascade(plants, {{.Kp = 5}, pi(0.55, 1.9)});
    ASSERT_TRUE(figures);
    EXPECT_NEAR(*figures->inner_load.IE, -1.9 / (0.55 * 5), 1e-9);
    EXPECT_NEAR(figures->Ms_outer, 1.338, 5e-4);
}

TEST(Cascade, AParallelCascadeIsThatOfThePlantBehindTheValve) {
    // L1 = C1 C2 P1/(1 + L2), and the valve's loop is the product.
    const CascadePlants plants{first_order(1, 4, 1), first_order(2, 20, 6), Arrangement::parallel};
    const IdealPid inner = pi(1, 4), outer = pi(0.4, 22);
    const auto all = cascade_diagram(plants, inner, &outer);
    ASSERT_TRUE(all);
    for (const double omega : {0.01, 0.1, 0.6}) {
        const std::complex<double> s(0, omega), C2 = controller_response(to_parallel(inner), s),
                                                C1 = controller_response(to_parallel(outer), s),
                                                L1 = C1 * C2 * plants.outer.at(s) / (1.0 + C2 * plants.inner.at(s));
        EXPECT_LT(std::abs(DiagramLoop(all->diagram, all->r2).at(omega).S - 1.0 / (1.0 + L1)), 1e-12);
    }
}

CascadeDesign limited(double M, bool joint) {
    return {.inner = {.Ms = M, .Mt = M}, .outer = {.Ms = M, .Mt = M}, .Ms_valve = joint ? M : 10, .joint = joint};
}

TEST(CascadeDesign, OptimaAreAtMostTwoPerMilleAboveThoseOfAnIndependentSearch) {
    const CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20)};
    struct Row {
        double M, outer, inner;
        bool joint;
    };
    for (const Row& row : {Row{1.4, 75.82, 6.142, false},
                           {1.4, 75.78, 6.092, true},
                           {1.6, 51.00, 3.995, false},
                           {1.6, 50.88, 3.869, true}}) {
        const auto result = design_cascade(plants, limited(row.M, row.joint), {});
        ASSERT_TRUE(result) << result.error().message;
        const CascadeFigures& f = result->figures;
        if (row.joint) {
            EXPECT_LE(*f.outer_load.IAE + *f.inner_load.IAE, 1.002 * (row.outer + row.inner)) << row.M;
        } else {
            EXPECT_LE(*f.outer_load.IAE, 1.002 * row.outer) << row.M;
        }
        EXPECT_LE(f.Ms_inner, row.M * (1 + 1e-5));
        EXPECT_LE(f.Ms_outer, row.M * (1 + 1e-5));
        if (row.joint) {
            EXPECT_LE(f.Ms_valve, row.M * (1 + 1e-5));
        }
    }
}

double finest_peak(const BlockDiagram& diagram, int signal) {
    double most = 0;
    for (double omega = 1e-4; omega < 1e3; omega *= 1.002)
        most = std::max(most, std::abs(diagram.response({0, omega}, signal)[signal]));
    return most;
}

TEST(CascadeDesign, LimitsHoldOnAFineGridAndJointIsNeverWorse) {
    RandomNumbers random(7);
    for (int i = 0; i < 8; ++i) {
        const double slow = random.log_uniform(1, 30);
        const CascadePlants plants{first_order(1, 1, random.log_uniform(0.1, 1)),
                                   first_order(random.log_uniform(0.5, 2), slow, slow * random.log_uniform(0.1, 1))};
        CascadeDesign design;
        const auto one = design_cascade(plants, design, {});
        design.joint = true;
        const auto both = design_cascade(plants, design, {});
        ASSERT_TRUE(one && both) << i;
        EXPECT_LE(*both->figures.outer_load.IAE + *both->figures.inner_load.IAE,
                  (1 + 1e-4) * (*one->figures.outer_load.IAE + *one->figures.inner_load.IAE))
            << i;
        for (const auto* result : {&*one, &*both}) {
            const auto all = cascade_diagram(plants, result->controllers.inner, &result->controllers.outer),
                       inner = cascade_diagram(plants, result->controllers.inner, nullptr);
            EXPECT_LE(finest_peak(all->diagram, all->valve), design.valve_limit() * (1 + 1e-4)) << i;
            EXPECT_LE(finest_peak(all->diagram, all->r2), 1.4 * (1 + 1e-4)) << i;
            EXPECT_LE(finest_peak(inner->diagram, inner->valve), 1.4 * (1 + 1e-4)) << i;
            EXPECT_TRUE(result->figures.stable);
        }
    }
}

TEST(CascadeDesign, AValveLimitBelowTheInnerPeakWeakensTheInnerLoop) {
    RandomNumbers random(11);
    for (int i = 0; i < 6; ++i) {
        const double slow = random.log_uniform(1.5, 20), valve = random.log_uniform(1.3, 1.45);
        const CascadePlants plants{first_order(-1, 1, random.log_uniform(0.1, 1)),
                                   first_order(2, slow, slow * random.log_uniform(0.1, 1)),
                                   i % 3 == 2 ? Arrangement::parallel : Arrangement::series};
        CascadeDesign design{.inner = {.Ms = 1.7, .Mt = 1.7}, .outer = {.Ms = 1.6, .Mt = 1.6}, .Ms_valve = valve};
        for (const bool joint : {false, true}) {
            design.joint = joint;
            const auto result = design_cascade(plants, design, {});
            ASSERT_TRUE(result) << i << ": " << result.error().message;
            const auto& [inner, outer] = result->controllers;
            const auto all = cascade_diagram(plants, inner, &outer);
            EXPECT_LE(finest_peak(all->diagram, all->valve), valve * (1 + 1e-5)) << i;
            EXPECT_LE(finest_peak(all->diagram, all->r2), 1.6 * (1 + 1e-5)) << i;
            EXPECT_GT(result->figures.Ms_outer, 1.1) << i << ": the outer loop is not given up";
        }
    }
}

TEST(CascadeDesign, WithAGivenInnerControllerALowerValveLimitIsRefused) {
    const CascadePlants plants{first_order(1, 1, 0.3), first_order(2, 10, 4)};
    CascadeDesign design;
    design.given_inner = pi(2, 1.2);
    design.Ms_valve = 1.3;
    const auto result = design_cascade(plants, design, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::no_feasible_controller);
}

TEST(Cascade, ThePeakAtTheValveIsThatOfTheHighestRippleOfASlowOuterLoop) {
    // The dead time of the outer loop turns its return to the valve a hundred times below the inner loop's peak.
    const CascadePlants plants{transfer({0.254}, {0.795, 3.437, 1}, 0.167), first_order(1.006, 94.5, 128.6),
                               Arrangement::parallel};
    const auto pair = design_cascade(plants, {.inner = {.Ms = 1.7, .Mt = 1.7}, .outer = {.Ms = 1.5, .Mt = 1.5}}, {});
    ASSERT_TRUE(pair) << pair.error().message;
    const auto all = cascade_diagram(plants, pair->controllers.inner, &pair->controllers.outer);
    double most = 0;
    for (double omega = 1; omega < 40; omega += 0.0007)
        most = std::max(most, std::abs(all->diagram.response({0, omega}, all->valve)[all->valve]));
    EXPECT_NEAR(pair->figures.Ms_valve, most, 1e-5 * most);
}

TEST(CascadeDesign, AGivenInnerControllerIsKeptAndAnUnstableOneRefused) {
    const CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20)};
    CascadeDesign design;
    design.given_inner = pi(0.5, 5);
    const auto kept = design_cascade(plants, design, {});
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_EQ(kept->controllers.inner, *design.given_inner);
    design.given_inner = pi(50, 5);
    const auto refused = design_cascade(plants, design, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "inner/controller");
}

TEST(CascadeDesign, ASingleLoopOnTheSamePlantsHasTheIntegralOfItsSettings) {
    const CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20)};
    const auto single = design_single_loop(plants, {.Ms = 1.4, .Mt = 1.4}, {});
    ASSERT_TRUE(single);
    EXPECT_NEAR(*single->inner_load.IAE, 81.38, 0.002 * 81.38);
    EXPECT_NEAR(*single->inner_load.IE, -single->controller.Ti / single->controller.Kp, 1e-6 * *single->inner_load.IAE);
}

TEST(Cascade, AnOuterPlantThatIntegratesIsDesigned) {
    // A level over a flow: the open outer plant is in no loop of the inner controller.
    for (const auto arrangement : {Arrangement::series, Arrangement::parallel}) {
        const CascadePlants plants{first_order(2, 4, 1),
                                   *LinearPlant::make(Plant(Zpk{.K = 0.05, .zeros = {}, .poles = {0.0}, .L = 2})),
                                   arrangement};
        const auto found = design_cascade(plants, {}, {});
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_TRUE(found->figures.stable);
        EXPECT_LE(found->figures.Ms_inner, limits::kDefaultMs * (1 + 1e-5));
        EXPECT_LE(found->figures.Ms_outer, limits::kDefaultMs * (1 + 1e-5));
        // r2 comes to rest where u cancels the load: in a parallel cascade the inner gain, 2, stands between them.
        const double IE =
            (arrangement == Arrangement::series ? 1 : 2) * found->controllers.outer.Ti / found->controllers.outer.Kp;
        EXPECT_NEAR(*found->figures.outer_load.IE, -IE, 1e-5 * IE);
    }
}

}  // namespace
}  // namespace tunewright::structure
