// Interacting loops: published gains and settings, bounds of the structured peak, designs within their limit.
#include "engine/structure/interaction.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "engine/loop/loop.h"
#include "engine/structure/interaction_gains.h"
#include "engine/structure/structured_peak.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

TEST(InteractionGains, RelativeGainsAndIndicesAreThePublishedOnes) {
    const auto wood_berry_gains = analyse_gains(wood_berry());
    ASSERT_TRUE(wood_berry_gains);
    EXPECT_NEAR(wood_berry_gains->relative[0][0], 12.8 * 19.4 / (12.8 * 19.4 - 18.9 * 6.6), 1e-12);
    EXPECT_NEAR(wood_berry_gains->relative[0][0], 2.009386632, 1e-8);
    EXPECT_NEAR(*wood_berry_gains->pairings[0].niederlinski, 0.497664304, 1e-8);
    EXPECT_EQ(wood_berry_gains->pairings[0].input_of, (std::vector<int>{0, 1}));
    EXPECT_FALSE(wood_berry_gains->pairings[1].possible);

    // MathWorks, column A in LV: 35.07, condition number 141.7.
    const auto column = analyse_gains({{first_order(87.8, 75, 0), first_order(-86.4, 75, 0)},
                                       {first_order(108.2, 75, 0), first_order(-109.6, 75, 0)}});
    ASSERT_TRUE(column);
    EXPECT_NEAR(column->relative[0][0], 35.068804665, 1e-6);
    EXPECT_NEAR(column->condition, 141.73, 0.01);
}

TEST(InteractionGains, TheCrossedPairingOfTheNonminimumPhaseTanksIsTheBest) {
    // Johansson (2000): relative gain -0.62 on the diagonal.
    const auto gains = analyse_gains({{first_order(1.5, 63, 0), transfer({2.5}, {2457, 102, 1})},
                                      {transfer({2.5}, {5096, 147, 1}), first_order(1.6, 91, 0)}});
    ASSERT_TRUE(gains);
    EXPECT_NEAR(gains->relative[0][0], -0.623376623, 1e-8);
    EXPECT_EQ(gains->pairings[0].input_of, (std::vector<int>{1, 0}));
    EXPECT_TRUE(gains->pairings[0].possible);
}

TEST(InteractionGains, AnIntegratingRowHasTheGainsOfItsSlopes) {
    const auto slope = [](double K) {
        return std::optional<LinearPlant>(*LinearPlant::make(Plant(Ipdt{.K = K, .L = 1})));
    };
    const auto gains = analyse_gains({{slope(2), slope(1)}, {first_order(1, 5, 1), first_order(3, 8, 1)}});
    ASSERT_TRUE(gains);
    EXPECT_NEAR(gains->relative[0][0], 6.0 / 5, 1e-12);
}

TEST(InteractionGains, SingularAndMisshapenMatricesAreRefused) {
    const auto singular =
        analyse_gains({{first_order(1, 5, 1), first_order(2, 5, 1)}, {first_order(2, 5, 1), first_order(4, 5, 1)}});
    ASSERT_FALSE(singular);
    EXPECT_EQ(singular.error().where, "plant");
    const auto short_row = analyse_gains({{first_order(1, 5, 1), first_order(2, 5, 1)}, {first_order(2, 5, 1)}});
    ASSERT_FALSE(short_row);
    EXPECT_EQ(short_row.error().where, "plant/1");
    EXPECT_FALSE(analyse_gains({{first_order(1, 5, 1)}}));
}

TEST(Blt, SettingsAreThoseThatLuybenPrinted) {
    struct Row {
        PlantMatrix plants;
        double F, Kp[2], Ti[2];
        double last_Kp[2], last_Ti[2];  // units of the last printed digits
    };
    const Row rows[] = {{wood_berry(), 2.5446090, {0.375, -0.075}, {8.29, 23.6}, {0.001, 0.001}, {0.01, 0.1}},
                        {vinante_luyben(), 2.2479787, {-1.07, 1.97}, {7.1, 2.58}, {0.01, 0.01}, {0.1, 0.01}}};
    for (const Row& row : rows) {
        const auto settings = blt(row.plants);
        ASSERT_TRUE(settings);
        EXPECT_NEAR(settings->F, row.F, 1e-4 * row.F);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(settings->controllers[i].Kp, row.Kp[i], 0.51 * row.last_Kp[i]);
            EXPECT_NEAR(settings->controllers[i].Ti, row.Ti[i], 0.51 * row.last_Ti[i]);
        }
    }
}

TEST(Interaction, TheFiguresOfLuybensSettingsAreThoseOfAnIndependentProgram) {
    const auto figures = judge_interaction(wood_berry(), {pi(0.375, 8.29), pi(-0.075, 23.6)});
    ASSERT_TRUE(figures && figures->stable);
    EXPECT_NEAR(figures->log_modulus, 3.97569106, 1e-4);
    EXPECT_NEAR(figures->mu, 1.94893861, 1e-4);
    EXPECT_NEAR(figures->Ms_alone[0], 1.320317004, 3e-5);
    EXPECT_NEAR(figures->Ms_alone[1], 1.283138692, 3e-5);
    EXPECT_NEAR(figures->Ms_others_closed[0], 1.350934876, 3e-5);
    EXPECT_NEAR(figures->Ms_others_closed[1], 1.501781718, 3e-5);
    EXPECT_TRUE(figures->unstable_subsets.empty());
    EXPECT_GE(figures->mu, *std::ranges::max_element(figures->Ms_others_closed));
}

TEST(Interaction, TheFiguresOfOgunnaikeAndRaysColumnAreThoseOfAnIndependentProgram) {
    // Three outputs, with Luyben's printed settings.
    const PlantMatrix plants{
        {first_order(0.66, 6.7, 2.6), first_order(-0.61, 8.64, 3.5), first_order(-0.0049, 9.06, 1)},
        {first_order(1.11, 3.25, 6.5), first_order(-2.36, 5, 3), first_order(-0.01, 7.09, 1.2)},
        {first_order(-34.68, 8.15, 9.2), first_order(46.2, 10.9, 9.4),
         transfer({10.1007, 0.87}, {73.132, 22.69, 1}, 1)}};
    const auto gains = analyse_gains(plants);
    ASSERT_TRUE(gains);
    EXPECT_NEAR(gains->relative[0][0], 2.008379032, 1e-8);
    EXPECT_NEAR(gains->relative[2][1], -0.102577277, 1e-8);
    const auto figures = judge_interaction(plants, {pi(1.51, 16.4), pi(-0.295, 18), pi(2.63, 6.61)});
    ASSERT_TRUE(figures && figures->stable);
    EXPECT_NEAR(figures->mu, 2.288465067, 1e-3);
    EXPECT_NEAR(figures->log_modulus, 5.930968166, 1e-3);
    EXPECT_NEAR(figures->Ms_others_closed[0], 1.572985636, 1e-4);
    EXPECT_NEAR(figures->Ms_alone[2], 1.354710646, 1e-4);
    EXPECT_TRUE(figures->unstable_subsets.empty());
}

TEST(Interaction, BoydHastAndAstromsControllersHaveTheirStructuredPeak) {
    // KP + KI/s + KD s/(1 + 0.3 s) on Wood and Berry's column; figures of an independent program.
    const auto pid = [](double P, double I, double D) {
        return *to_ideal(ParallelPid{.Kp = P, .Ki = I, .Kd = D, .filter = {FilterType::derivative, 0.3}});
    };
    const auto figures = judge_interaction(wood_berry(), {pid(0.1535, 0.0210, 0.1714), pid(-0.0692, -0.0136, -0.1725)});
    ASSERT_TRUE(figures && figures->stable);
    EXPECT_NEAR(figures->mu, 1.399398426, 1e-4);
    EXPECT_NEAR(figures->log_modulus, 3.657984682, 1e-3);
    EXPECT_NEAR(figures->Ms_others_closed[1], 1.303214507, 1e-4);
}

TEST(Interaction, OneWayInteractionLeavesThePeaksOfTheLoopsAlone) {
    const PlantMatrix plants{{first_order(2, 8, 2), {}}, {first_order(5, 3, 1), first_order(1, 12, 4)}};
    const auto figures = judge_interaction(plants, {pi(1.2, 8), pi(1.8, 12)});
    ASSERT_TRUE(figures && figures->stable);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(figures->Ms_others_closed[i], figures->Ms_alone[i], 1e-6);
    EXPECT_NEAR(figures->mu, *std::ranges::max_element(figures->Ms_alone), 1e-5);
    EXPECT_NEAR(figures->IAE_load[1][0], 0, 1e-12) << "the second loop does not move the first output";
}

TEST(Interaction, APeakSaysNothingAboutStability) {
    // mu is below 1.8 on Wood and Berry's column with these settings, and two poles are unstable.
    const auto figures = judge_interaction(wood_berry(), {pi(0.23, 2.8), pi(-0.51, 0.41)});
    ASSERT_TRUE(figures);
    EXPECT_FALSE(figures->stable);
    EXPECT_FALSE(figures->unstable_subsets.empty());
}

TEST(Interaction, OptimaAreAtMostTwoPerMilleAboveThoseOfAnIndependentSearch) {
    struct Row {
        PlantMatrix plants;
        double mu, cost;
    };
    const Row rows[] = {{wood_berry(), 1.8, 114.94}, {vinante_luyben(), 1.6, 6.004}, {vinante_luyben(), 1.8, 4.277}};
    for (const Row& row : rows) {
        const auto result = design_interaction(row.plants, {.mu = row.mu}, {});
        ASSERT_TRUE(result) << result.error().message;
        double cost = 0;
        for (const auto& load : result->figures.IAE_load)
            for (const double IAE : load) cost += IAE;
        EXPECT_LE(cost, 1.002 * row.cost) << row.mu;
        EXPECT_LE(result->figures.mu, row.mu * (1 + 1e-5));
        EXPECT_TRUE(result->figures.stable);
        EXPECT_TRUE(result->figures.unstable_subsets.empty());
    }
}

/// mu of S by the formula for two loops, on a grid that resolves every turn of the dead times.
double finest_mu(const PlantMatrix& plants, const std::vector<IdealPid>& controllers) {
    double most = 0;
    const auto value = [&](double omega) {
        const std::complex<double> s(0, omega), C0 = controller_response(to_parallel(controllers[0]), s),
                                                C1 = controller_response(to_parallel(controllers[1]), s);
        const auto a = 1.0 + plants[0][0]->at(s) * C0, b = plants[0][1]->at(s) * C1, c = plants[1][0]->at(s) * C0,
                   d = 1.0 + plants[1][1]->at(s) * C1, det = a * d - b * c;
        const double f = (std::norm(a) + std::norm(d) + 2 * std::abs(b * c)) / std::norm(det);
        return std::sqrt((f + std::sqrt(f * f - 4 / std::norm(det))) / 2);
    };
    for (double omega = 1e-4; omega < 30; omega *= 1.0003) most = std::max(most, value(omega));
    return most;
}

TEST(Interaction, TheLimitHoldsBetweenTheFrequenciesOfTheSearch) {
    // The first two plants have their peak in a narrow ripple of the dead times.
    std::vector<PlantMatrix> cases{{{first_order(2.18, 5.64, 0.306), first_order(-6.02, 13.3, 2.59)},
                                    {first_order(0.531, 20.5, 0.698), first_order(0.889, 4.92, 2.04)}}};
    RandomNumbers random(5);
    for (int i = 0; i < 5; ++i) {
        const auto plant = [&](double K) {
            return first_order(K, random.log_uniform(3, 30), random.log_uniform(0.3, 6));
        };
        const double product = 1 - 1 / random.log_uniform(0.4, 4);
        cases.push_back({{plant(1), plant(product)}, {plant(1), plant(1)}});
    }
    for (const PlantMatrix& plants : cases) {
        const auto result = design_interaction(plants, {.mu = 1.9}, {});
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_LE(finest_mu(plants, result->controllers), 1.9 * (1 + 1e-5));
    }
}

TEST(StructuredPeak, OfAProductOfTwoVectorsItIsTheSumOfTheirProducts) {
    // S = a b^H with one complex gain in each row: mu = sum |a_i b_i|.
    RandomNumbers random(3);
    for (const Eigen::Index n : {2, 3}) {
        StructuredValues one_after_the_other;
        for (int i = 0; i < 40; ++i) {
            Eigen::VectorXcd a(n), b(n);
            for (Eigen::Index k = 0; k < n; ++k) {
                a[k] = std::polar(random.log_uniform(0.1, 10), random.log_uniform(0.1, 6));
                b[k] = std::polar(random.log_uniform(0.1, 10), random.log_uniform(0.1, 6));
            }
            const double expected = a.cwiseAbs().dot(b.cwiseAbs());
            EXPECT_NEAR(structured_value(a * b.adjoint()), expected, 1e-7 * expected);
            EXPECT_NEAR(one_after_the_other(a * b.adjoint()), expected, 1e-7 * expected);
        }
    }
}

TEST(StructuredPeak, ScaledRowsAndColumnsLeaveItAsItIs) {
    RandomNumbers random(4);
    for (int i = 0; i < 20; ++i) {
        Eigen::Matrix3cd S;
        for (auto& entry : S.reshaped()) entry = std::polar(random.log_uniform(0.2, 5), random.log_uniform(0.1, 6));
        const Eigen::Vector3d d(random.log_uniform(0.1, 10), 1, random.log_uniform(0.1, 10));
        const double value = structured_value(S);
        EXPECT_NEAR(structured_value(d.asDiagonal() * S * d.cwiseInverse().asDiagonal()), value, 1e-5 * value);
        EXPECT_GE(value, S.diagonal().cwiseAbs().maxCoeff());
        EXPECT_LE(value, S.operatorNorm() * (1 + 1e-12));
    }
    EXPECT_NEAR(structured_value(Eigen::Matrix3cd::Identity()), 1, 1e-12) << "equal singular values";
}

TEST(Interaction, ARowWhosePlantsIntegrateIsStableAndHasTheIntegralOfItsLoop) {
    // A level that both inflows move, and a temperature. The IE of y1 after a load at u1 is that of both loops at rest:
    // u1 takes back the load, so that the integral of e1 is -Ti1/Kp1.
    const auto slope = [](double K, double L) {
        return std::optional<LinearPlant>(*LinearPlant::make(Plant(Ipdt{.K = K, .L = L})));
    };
    const PlantMatrix plants{{slope(0.2, 1), slope(0.1, 2)}, {first_order(1, 6, 1), first_order(-2, 9, 2)}};
    const std::vector<IdealPid> controllers{pi(1.2, 15), pi(-0.8, 9)};
    const auto figures = judge_interaction(plants, controllers);
    ASSERT_TRUE(figures);
    EXPECT_TRUE(figures->stable);
    EXPECT_TRUE(figures->unstable_subsets.empty());
    EXPECT_GE(figures->IAE_load[0][0], 15 / 1.2 - 1e-6) << "the IAE is at least the magnitude of the integral";
    EXPECT_LT(figures->mu, 3);
    const auto design = design_interaction(plants, {.mu = 1.6}, {});
    ASSERT_TRUE(design) << design.error().message;
    EXPECT_LE(design->figures.mu, 1.6 * (1 + 1e-5));
    EXPECT_TRUE(design->figures.unstable_subsets.empty());
}

TEST(Interaction, LoopsInManualDoNotMakeTheOthersUnstable) {
    // The second output integrates; alone in automatic the first loop is as stable as without it.
    const PlantMatrix plants{{first_order(1, 5, 1), first_order(0.3, 5, 1)},
                             {{}, *LinearPlant::make(Plant(Ipdt{.K = 0.1, .L = 1}))}};
    const auto figures = judge_interaction(plants, {pi(1, 5), pi(2, 20)});
    ASSERT_TRUE(figures);
    EXPECT_TRUE(figures->unstable_subsets.empty());
    EXPECT_EQ(figures->may_open, (std::vector<bool>{true, true}));
}

TEST(Interaction, ADiagonalWithoutAPathIsRefused) {
    const PlantMatrix plants{{{}, first_order(2, 5, 1)}, {first_order(2, 5, 1), first_order(1, 5, 1)}};
    const auto figures = judge_interaction(plants, {pi(1, 5), pi(1, 5)});
    ASSERT_FALSE(figures);
    EXPECT_EQ(figures.error().where, "pairing");
}

}  // namespace
}  // namespace tunewright::structure
