// Interacting loops: published gains and settings, bounds of the structured peak, designs within their limit.
#include "engine/structure/interaction.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
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
    // F recomputed by another program; settings to half a unit of the last printed digit. Those of Wardle and Wood and
    // of Ogunnaike and Ray were printed from a rounded F of 2.15: 0.7 %.
    constexpr double kRoundedF = 7e-3;
    struct Setting {
        double printed, room;
    };
    struct Row {
        PlantMatrix plants;
        double F;
        std::vector<Setting> Kp, Ti;
    };
    const auto rounded = [](double printed) { return Setting{printed, kRoundedF * std::abs(printed)}; };
    const Row rows[] = {{wood_berry(), 2.544609041, {{0.375, 5e-4}, {-0.075, 5e-4}}, {{8.29, 0.005}, {23.6, 0.05}}},
                        {vinante_luyben(), 2.247978674, {{-1.07, 0.005}, {1.97, 0.005}}, {{7.1, 0.05}, {2.58, 0.005}}},
                        {wardle_wood(), 2.15365673, {rounded(27.4), rounded(-13.3)}, {rounded(41.4), rounded(52.9)}},
                        {ogunnaike_ray(),
                         2.136613918,
                         {rounded(1.51), rounded(-0.295), rounded(2.63)},
                         {rounded(16.4), {18, 0.15}, rounded(6.61)}},
                        {polymerisation(), 3.453583144, {{0.21, 5e-4}, {0.175, 5e-4}}, {{2.26, 0.005}, {4.25, 0.005}}}};
    for (const Row& row : rows) {
        const auto settings = blt(row.plants);
        ASSERT_TRUE(settings);
        EXPECT_NEAR(settings->F, row.F, 1e-4 * row.F);
        for (std::size_t i = 0; i < row.Kp.size(); ++i) {
            EXPECT_NEAR(settings->controllers[i].Kp, row.Kp[i].printed, row.Kp[i].room) << row.F;
            EXPECT_NEAR(settings->controllers[i].Ti, row.Ti[i].printed, row.Ti[i].room) << row.F;
        }
    }
}

/// P and C of two loops at one frequency.
struct TwoLoops {
    Eigen::Matrix2cd P, C = Eigen::Matrix2cd::Zero();

    TwoLoops(const PlantMatrix& plants, const std::vector<IdealPid>& controllers, double omega) {
        const std::complex<double> s(0, omega);
        for (Eigen::Index i = 0; i < 2; ++i) {
            for (Eigen::Index j = 0; j < 2; ++j) P(i, j) = plants[std::size_t(i)][std::size_t(j)]->at(s);
            C(i, i) = controller_response(to_parallel(controllers[std::size_t(i)]), s);
        }
    }
    Eigen::Matrix2cd S() const { return (Eigen::Matrix2cd::Identity() + P * C).inverse(); }
};

TEST(Interaction, BoydHastAndAstromsControllersHaveTheirThreePublishedPeaks) {
    // KP + KI/s + KD s/(1 + 0.3 s): limits 1.4, 1.4 and 3/sigma_min(P(0)) = 0.7381 on the largest singular values of
    // S, T and Q = C S, all active but for the rounding of the settings.
    const auto pid = [](double P, double I, double D) {
        return *to_ideal(ParallelPid{.Kp = P, .Ki = I, .Kd = D, .filter = {FilterType::derivative, 0.3}});
    };
    const std::vector<IdealPid> controllers{pid(0.1535, 0.0210, 0.1714), pid(-0.0692, -0.0136, -0.1725)};
    double S_peak = 0, T_peak = 0, Q_peak = 0;
    for (double omega = 1e-3; omega < 100; omega *= 1.0005) {
        const TwoLoops loops(wood_berry(), controllers, omega);
        const Eigen::Matrix2cd S = loops.S();
        S_peak = std::max(S_peak, S.operatorNorm());
        T_peak = std::max(T_peak, (Eigen::Matrix2cd::Identity() - S).eval().operatorNorm());
        Q_peak = std::max(Q_peak, (loops.C * S).eval().operatorNorm());
    }
    EXPECT_NEAR(S_peak, 1.4024, 1e-4);
    EXPECT_NEAR(T_peak, 1.4026, 1e-4);
    EXPECT_NEAR(Q_peak, 0.7385, 1e-4);
}

TEST(Interaction, TheSensitivityOfALoopWithTheOthersClosedIsOnTheDiagonalOfTheirs) {
    // S_ii = 1/(1 + L_i): the loop's own figures against the inverse of the matrix.
    const std::vector<IdealPid> controllers{pi(0.6, 9.7), pi(-0.03, 2.6)};
    const auto figures = judge_interaction(wood_berry(), controllers);
    ASSERT_TRUE(figures && figures->stable);
    for (Eigen::Index i = 0; i < 2; ++i) {
        double most = 0;
        for (double omega = 0.02; omega < 5; omega *= 1.00005)
            most = std::max(most, std::abs(TwoLoops(wood_berry(), controllers, omega).S()(i, i)));
        EXPECT_NEAR(figures->Ms_others_closed[std::size_t(i)], most, 1e-7 * most);
    }
}

/// Two equal loops of relative gain lambda with proportional action.
bool equal_loops_are_stable(double lambda, double gain) {
    const double cross = std::sqrt(std::abs(1 - 1 / lambda)), sign = lambda < 1 ? -1 : 1;
    const PlantMatrix plants{{first_order(1, 10, 1), first_order(sign * cross, 10, 1)},
                             {first_order(cross, 10, 1), first_order(1, 10, 1)}};
    const auto figures = judge_interaction(plants, {{.Kp = gain}, {.Kp = gain}});
    return figures && figures->stable;
}

TEST(Interaction, TwoEqualLoopsAreStableUpToTheGainsOfShinskeysTable) {
    // Table 8.1: x^2/lambda + 2 x + 1 = 0 for the loop x alone: -0.586 (lambda 2), -0.5 (infinite), and 0.707 at -135
    // degrees (lambda 0.5).
    const auto where = [](double phase) {  // the plant's magnitude where it has this phase
        double low = 1e-3, high = 10;
        for (int i = 0; i < 80; ++i) {
            const double middle = (low + high) / 2;
            (std::atan(10 * middle) + middle < phase ? low : high) = middle;
        }
        return 1 / std::hypot(1, 10 * low);
    };
    const double half_turn = where(std::numbers::pi), at_135 = where(0.75 * std::numbers::pi);
    struct Row {
        double lambda, ultimate;
    };
    for (const Row& row : {Row{2, (2 - std::numbers::sqrt2) / half_turn},
                           {1e9, 0.5 / half_turn},
                           {0.5, std::numbers::sqrt2 / 2 / at_135}}) {
        EXPECT_TRUE(equal_loops_are_stable(row.lambda, 0.999 * row.ultimate)) << row.lambda;
        EXPECT_FALSE(equal_loops_are_stable(row.lambda, 1.001 * row.ultimate)) << row.lambda;
    }
}

TEST(InteractionGains, ADecouplersErrorChangesTheSignOfTheIndexAtShinskeysLimit) {
    // Table 8.2: 73, 41, 6.9, 3.3 % for relative gains of 1.5, 2, 8, 16; exactly sqrt(lambda/(lambda - 1)) - 1.
    struct Row {
        double lambda, printed, last;
    };
    for (const Row& row : {Row{1.5, 0.73, 0.005}, {2, 0.41, 0.005}, {8, 0.069, 5e-4}, {16, 0.033, 5e-4}}) {
        const double cross = std::sqrt(1 - 1 / row.lambda);
        const auto index = [&](double error) {
            const double D = -cross * (1 + error);  // both decouplers of the plant [1, cross; cross, 1]
            const auto gain = [](double K) { return first_order(K, 5, 1); };
            const auto gains =
                analyse_gains({{gain(1 + cross * D), gain(cross + D)}, {gain(cross + D), gain(1 + cross * D)}});
            for (const Pairing& pairing : gains->pairings)
                if (pairing.input_of[0] == 0) return *pairing.niederlinski;
            return 0.0;
        };
        double low = 0, high = 0.99 / (row.lambda - 1);
        for (int i = 0; i < 20; ++i) {  // nearer to the limit the gains are refused as singular
            const double middle = (low + high) / 2;
            (index(middle) > 0 ? low : high) = middle;
        }
        EXPECT_NEAR(low, row.printed, row.last) << row.lambda;
        EXPECT_NEAR(low, std::sqrt(row.lambda / (row.lambda - 1)) - 1, 3e-6) << row.lambda;
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
    const PlantMatrix plants = ogunnaike_ray();
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

TEST(StructuredPeak, ValuesThatAreNotAboveTheLeastAreBoundsOfIt) {
    RandomNumbers random(6);
    constexpr double kLeast = 1.3;
    StructuredValues bounded(kLeast);
    int below = 0, above = 0;
    for (int i = 0; i < 200; ++i) {
        Eigen::Matrix3cd S;
        for (auto& entry : S.reshaped()) entry = std::polar(random.log_uniform(0.05, 1.5), random.log_uniform(0.1, 6));
        const double value = structured_value(S), found = bounded(S);
        EXPECT_GE(found, value * (1 - 1e-6));
        if (value > kLeast)
            EXPECT_NEAR(found, value, 1e-5 * value);
        else
            EXPECT_LE(found, kLeast);
        ++(value > kLeast ? above : below);
    }
    EXPECT_GT(std::min(above, below), 20);
}

TEST(Interaction, TheDesignDoesNotDependOnTheOrderOfItsParts) {
    int parts = 0;
    RunControl backwards;
    backwards.spread = [&parts](int n, const std::function<void(int)>& f) {
        parts += n;
        for (int i = n; i-- > 0;) f(i);
    };
    const auto forwards = design_interaction(wood_berry(), {.mu = 1.8}, {});
    const auto other = design_interaction(wood_berry(), {.mu = 1.8}, backwards);
    ASSERT_TRUE(forwards && other);
    EXPECT_GE(parts, 3) << "each start is a part";
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(forwards->controllers[i].Kp, other->controllers[i].Kp);
        EXPECT_EQ(forwards->controllers[i].Ti, other->controllers[i].Ti);
    }
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
