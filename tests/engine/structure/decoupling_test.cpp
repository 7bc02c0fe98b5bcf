// Decouplers of interacting loops: elements by hand, P D by its own arithmetic, figures by closed forms.
#include "engine/structure/decoupling/decoupler_blocks.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "engine/structure/conclusions.h"
#include "engine/structure/interaction.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;

LoopMatrix plant_response(const PlantMatrix& plants, Complex s) {
    const auto n = Eigen::Index(plants.size());
    LoopMatrix P = LoopMatrix::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            if (const auto& one = plants[std::size_t(i)][std::size_t(j)]) P(i, j) = one->at(s);
    return P;
}

void expect_element(const std::optional<Feedforward>& element, double Kf, double Tz, double Tp, double Lf) {
    ASSERT_TRUE(element);
    EXPECT_NEAR(element->Kf, Kf, 1e-12);
    EXPECT_NEAR(element->Tz, Tz, 1e-9);
    EXPECT_NEAR(element->Tp, Tp, 1e-9);
    EXPECT_NEAR(element->Lf, Lf, 1e-12);
}

double largest_off_diagonal(LoopMatrix M) {
    M.diagonal().setZero();
    return M.cwiseAbs().maxCoeff();
}

double cost(const InteractionFigures& figures) {
    double sum = 0;
    for (const auto& row : figures.IAE_load)
        for (const double one : row) sum += one;
    return sum;
}

TEST(Decoupler, StaticGainsMakeThePlantDiagonalAtSteadyState) {
    PlantMatrix integrating = wood_berry();
    integrating[0] = {*LinearPlant::make(Plant(Ipdt{.K = 0.4, .L = 1})),
                      *LinearPlant::make(Plant(Ipdt{.K = -0.1, .L = 3}))};
    const PlantMatrix three{{first_order(2, 5, 1), first_order(0.5, 4, 1), first_order(-0.3, 6, 2)},
                            {first_order(0.4, 5, 1), first_order(-1.5, 4, 1), first_order(0.2, 6, 2)},
                            {first_order(0.1, 5, 1), first_order(0.3, 4, 1), first_order(1.2, 6, 2)}};
    for (const PlantMatrix& plants : {wood_berry(), vinante_luyben(), integrating, three}) {
        const auto decoupler = design_decoupler(plants, DecouplerKind::static_gains);
        ASSERT_TRUE(decoupler);
        const auto gains = analyse_gains(plants);
        const auto n = Eigen::Index(plants.size());
        LoopMatrix K(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < n; ++j) K(i, j) = gains->gain[std::size_t(i)][std::size_t(j)];
        const LoopMatrix KD = K * decoupler_response(decoupler->elements, 0);
        EXPECT_LT(largest_off_diagonal(KD), 1e-12);
        for (Eigen::Index i = 0; i < n; ++i) EXPECT_NEAR(std::abs(KD(i, i) - K(i, i)), 0, 1e-12);
    }
    const auto decoupler = design_decoupler(wood_berry(), DecouplerKind::static_gains);
    expect_element(decoupler->elements[0][1], 18.9 / 12.8, 0, 0, 0);
    expect_element(decoupler->elements[1][0], 6.6 / 19.4, 0, 0, 0);
    EXPECT_FALSE(decoupler->elements[0][0]);
}

TEST(Decoupler, SimplifiedElementsAreRatiosOfThePlants) {
    const auto decoupler = design_decoupler(wood_berry(), DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    expect_element(decoupler->elements[0][1], 18.9 / 12.8, 16.7, 21, 2);
    expect_element(decoupler->elements[1][0], 6.6 / 19.4, 14.4, 10.9, 4);
    EXPECT_EQ(decoupler->unrealised, (Table{{0, 0}, {0, 0}}));
    for (const double omega : {0.0, 0.01, 0.1, 0.7, 5.0}) {
        const LoopMatrix P = plant_response(wood_berry(), {0, omega}),
                         PD = P * decoupler_response(decoupler->elements, {0, omega});
        EXPECT_LT(largest_off_diagonal(PD), 1e-12 * P.cwiseAbs().maxCoeff()) << omega;
        EXPECT_LT((PD - P).diagonal().cwiseAbs().maxCoeff(), 1e-12 * P.cwiseAbs().maxCoeff()) << omega;
    }
}

TEST(Decoupler, AnAdvanceIsLeftOutAndReported) {
    const auto decoupler = design_decoupler(vinante_luyben(), DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    expect_element(decoupler->elements[0][1], 1.3 / 2.2, 0, 0, 0);  // equal lags
    expect_element(decoupler->elements[1][0], 2.8 / 4.3, 9.2, 9.5, 1.45);
    EXPECT_NEAR(decoupler->unrealised[0][1], 0.7, 1e-12);
    EXPECT_EQ(decoupler->unrealised[1][0], 0);
}

TEST(Decoupler, EqualLagsCancelAndALeadAloneGetsALag) {
    // Johansson's tanks: -1.5/((23s+1)(62s+1)) over 2.6/(62s+1) is a lag alone.
    const PlantMatrix tanks{{first_order(2.6, 62, 1), transfer({1.5}, {1426, 85, 1}, 1)},
                            {first_order(1.4, 0, 1), first_order(2.8, 90, 1)}};
    const auto decoupler = design_decoupler(tanks, DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    expect_element(decoupler->elements[0][1], -1.5 / 2.6, 0, 23, 0);
    expect_element(decoupler->elements[1][0], -0.5, 90, 9, 0);
}

TEST(Decoupler, WhatCannotRunIsRefusedWithItsReason) {
    using enum DecouplerKind;
    const auto refusal = [](const PlantMatrix& plants, DecouplerKind kind) {
        const auto decoupler = design_decoupler(plants, kind);
        return decoupler ? std::string() : decoupler.error().message;
    };
    // Relative gain 1/3: the elements feed each other with a gain of 2.
    const PlantMatrix crossed{{first_order(1, 5, 1), first_order(-2, 5, 1)},
                              {first_order(1, 5, 1), first_order(1, 5, 1)}};
    EXPECT_NE(refusal(crossed, static_gains).find("not stable by itself"), std::string::npos);
    PlantMatrix slope = wood_berry();
    slope[0][1] = *LinearPlant::make(Plant(Ipdt{.K = 1, .L = 1}));
    EXPECT_NE(refusal(slope, static_gains).find("no gain at steady state"), std::string::npos);
    EXPECT_NE(refusal(slope, simplified).find("integrators"), std::string::npos);
    PlantMatrix inverse = wood_berry();
    inverse[0][0] = transfer({-9 * 12.8, 12.8}, {16.7, 1}, 1);
    EXPECT_EQ(refusal(inverse, static_gains), "");
    PlantMatrix early = wood_berry();
    early[0][0] = transfer({-30 * 12.8, 12.8}, {16.7 * 5, 21.7, 1}, 1);
    EXPECT_NE(refusal(early, simplified).find("right half-plane"), std::string::npos);
    PlantMatrix unstable = wood_berry();
    unstable[0][1] = transfer({1}, {-5, 1}, 1);
    EXPECT_NE(refusal(unstable, simplified).find("not stable"), std::string::npos);
}

TEST(Decoupling, PerfectDecouplingLeavesTheLoopsAlone) {
    const PlantMatrix plants = wood_berry();
    const auto decoupler = design_decoupler(plants, DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    const std::vector<IdealPid> controllers{pi(0.2, 16.7), pi(-0.1, 14.4)};
    for (const double omega : {0.01, 0.1, 0.5, 2.0}) {
        const Complex s(0, omega);
        LoopMatrix L = plant_response(plants, s) * decoupler_response(decoupler->elements, s);
        for (Eigen::Index i = 0; i < 2; ++i) {
            const IdealPid& c = controllers[std::size_t(i)];
            L.col(i) *= c.Kp * (1.0 + 1.0 / (c.Ti * s));
        }
        const LoopMatrix S = (LoopMatrix::Identity(2, 2) + L).inverse();
        EXPECT_LT(largest_off_diagonal(S), 1e-9) << omega;
    }
    const auto figures = judge_interaction(plants, controllers, decoupler->elements);
    ASSERT_TRUE(figures);
    ASSERT_TRUE(figures->stable);
    EXPECT_TRUE(figures->unstable_subsets.empty());
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(figures->Ms_others_closed[i], figures->Ms_alone[i], 1e-6);
        EXPECT_LT(figures->IAE_setpoint[1 - i][i], 1e-6 * figures->IAE_setpoint[i][i]);
    }
    EXPECT_NEAR(figures->mu, std::ranges::max(figures->Ms_alone), 1e-6);
    // y_i = S_i P_ij d_j, since the decoupler does not see loads; none changes its sign: |IE| = |K_ij Ti/(Kp K_ii)|.
    EXPECT_NEAR(figures->IAE_load[0][0], 16.7 / 0.2, 1e-3 * 83);
    EXPECT_NEAR(figures->IAE_load[1][0], 18.9 * 16.7 / (0.2 * 12.8), 1e-3 * 123);
    EXPECT_NEAR(figures->IAE_load[0][1], 6.6 * 14.4 / (0.1 * 19.4), 1e-3 * 49);
    EXPECT_NEAR(figures->IAE_load[1][1], 14.4 / 0.1, 1e-3 * 144);
}

TEST(Decoupling, ADiagonalPlantGainsNothing) {
    const PlantMatrix plants{{first_order(2, 5, 1), {}}, {{}, first_order(-1, 8, 2)}};
    const std::vector<IdealPid> controllers{pi(1.2, 4), pi(-2, 6)};
    const auto none = judge_interaction(plants, controllers);
    ASSERT_TRUE(none);
    for (const auto kind : {DecouplerKind::static_gains, DecouplerKind::simplified}) {
        const auto decoupler = design_decoupler(plants, kind);
        ASSERT_TRUE(decoupler);
        for (const auto& row : decoupler->elements)
            for (const auto& element : row) EXPECT_FALSE(element);
        const auto figures = judge_interaction(plants, controllers, decoupler->elements);
        ASSERT_TRUE(figures);
        EXPECT_NEAR(cost(*figures), cost(*none), 1e-6 * cost(*none));
        EXPECT_NEAR(figures->mu, none->mu, 1e-6);
    }
}

TEST(Decoupling, AGainThatIsWrongByOneOverTheRelativeGainIsUnstable) {
    // Column A with a dead time, relative gain 35.07: 1/35.07 is 2.85 %.
    const PlantMatrix column{{first_order(87.8, 75, 1), first_order(-86.4, 75, 1)},
                             {first_order(108.2, 75, 1), first_order(-109.6, 75, 1)}};
    const auto decoupler = design_decoupler(column, DecouplerKind::static_gains);
    ASSERT_TRUE(decoupler);
    const std::vector<IdealPid> controllers{pi(0.3, 20), pi(-0.24, 20)};
    const WrongGains exact = with_wrong_gains(column, controllers, decoupler->elements, 1e-9),
                     little = with_wrong_gains(column, controllers, decoupler->elements, 0.01),
                     near = with_wrong_gains(column, controllers, decoupler->elements, 0.03);
    EXPECT_TRUE(exact.stable);
    const auto figures = judge_interaction(column, controllers, decoupler->elements);
    EXPECT_NEAR(*exact.mu, figures->mu, 1e-4);
    EXPECT_TRUE(little.stable);
    EXPECT_GT(*little.mu, *exact.mu);
    EXPECT_FALSE(near.stable || near.mu);
}

TEST(Decoupling, TheDesignKeepsItsLimitAndGainsWhereDecouplingPays) {
    const auto decoupler = design_decoupler(polymerisation(), DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    const auto with = design_interaction(polymerisation(), {.mu = 1.8, .decoupling = decoupler->elements}, {}),
               without = design_interaction(polymerisation(), {.mu = 1.8}, {});
    ASSERT_TRUE(with);
    ASSERT_TRUE(without);
    EXPECT_LE(with->figures.mu, 1.8 * (1 + 1e-5));
    EXPECT_TRUE(with->figures.unstable_subsets.empty());
    EXPECT_GT(cost(without->figures), 1.7 * cost(with->figures));
    // The same settings cost as much without the search.
    const auto again = judge_interaction(polymerisation(), with->controllers, decoupler->elements);
    ASSERT_TRUE(again);
    EXPECT_NEAR(cost(*again), cost(with->figures), 1e-9 * cost(*again));
}

TEST(Decoupling, ConclusionsAreDrawnFromGainAndWrongGains) {
    const auto codes = [](const Figure& gain, double mu, const WrongGains& wrong, double relative) {
        std::string out;
        for (const Conclusion& one : conclusions_on_decoupler(gain, mu, wrong, relative))
            out += to_string(one.code) + " ";
        return out;
    };
    const WrongGains well{0.2, true, 2.2};
    EXPECT_EQ(codes(1.3, 1.8, well, 2), "decoupler-helps ");
    EXPECT_EQ(codes(1.05, 1.8, well, 2), "");
    EXPECT_EQ(codes(0.9, 1.8, well, 2), "decoupler-worse-than-none ");
    EXPECT_EQ(codes(1.3, 1.8, {0.2, true, 2.8}, 2), "decoupler-helps decoupler-fragile ");
    EXPECT_EQ(codes({}, 1.8, {0.2, false, {}}, 2), "decoupler-fragile ");
    EXPECT_EQ(codes({}, 1.8, well, 6), "decoupler-fragile ");
}

}  // namespace
}  // namespace tunewright::structure
