// Rules for a given robustness: their formulas, and the robustness of the loops.
#include "engine/evaluation/evaluate.h"
#include "engine/plant/plant_family.h"
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::expect_settings;
using test::Given;
using test::kPI;
using test::tuned;
using test::warns;
using test::word;

Robustness robustness_of(const Plant& plant, const Expected<TunedController>& answer) {
    EvaluateOptions options;
    options.points = 0;
    return evaluate(PlantModel(plant), answer->controller, options)->robustness;
}

const Given kUnfiltered{{"filter/Tf_over_Td", 0.0}};

TEST(Haalman, CancelsTheLagsSoThatMsIs1Point9WhateverTheyAre) {
    for (const double T : {0.1, 1.0, 5.0}) {
        const Fopdt first{.K = -2, .T = T, .L = 1};
        const auto pi = tuned("haalman", first, kPI);
        expect_settings(pi, -T / 3, T, 0);
        EXPECT_NEAR(*robustness_of(first, pi).Ms, 1.917, 2e-3);
        const Sopdt second{.K = 3, .T1 = T, .T2 = T / 2, .L = 1};
        const auto pid = tuned("haalman", second, kUnfiltered);
        expect_settings(pid, 2 * 1.5 * T / 9, 1.5 * T, T / 3);
        EXPECT_NEAR(*robustness_of(second, pid).Ms, 1.917, 2e-3);
    }
    EXPECT_TRUE(warns(*tuned("haalman", Fopdt{.K = 1, .T = 2, .L = 1}), "no-derivative"));
}

// The source approximates the arctangents by straight lines: both margins within 7 %, exact at 3 and 60 degrees, where
// Ti = T.
TEST(GainPhaseMargin, MeetsBothMargins) {
    expect_settings(tuned("gain_phase_margin", Fopdt{.K = 2, .T = 4, .L = 1}, kPI), 3.14159265358979 / 3, 4, 0);
    struct Wanted {
        double gain, phase_deg;
    };
    for (const auto& [gain, phase_deg] : {Wanted{3, 60}, Wanted{2, 45}, Wanted{4, 65}, Wanted{5, 70}}) {
        for (const double L : {0.2, 0.5, 1.0}) {
            const Given given{{"gain_margin", gain}, {"phase_margin_deg", phase_deg}, word("controller", "PI")};
            const Fopdt plant{.K = 1, .T = 1, .L = L};
            const auto margins = robustness_of(plant, tuned("gain_phase_margin", plant, given));
            EXPECT_NEAR(*margins.gain_margin, gain, 0.07 * gain) << phase_deg << " " << L;
            EXPECT_NEAR(*margins.phase_margin_deg, phase_deg, 0.07 * phase_deg) << gain << " " << L;
        }
    }
    // PID: the second lag is cancelled, the rest is a PI.
    const Sopdt plant{.K = 1, .T1 = 4, .T2 = 1, .L = 1};
    const auto pid = tuned("gain_phase_margin", plant, kUnfiltered);
    expect_settings(pid, 3.14159265358979 / 6 * 4 * 1.25, 5, 0.8);
    EXPECT_NEAR(*robustness_of(plant, pid).gain_margin, 3, 1e-3);
}

TEST(GainPhaseMargin, RefusesMarginsThatContradictEachOther) {
    const auto answer =
        tuned("gain_phase_margin", Fopdt{.K = 1, .T = 100, .L = 1}, {{"gain_margin", 2.0}, {"phase_margin_deg", 80.0}});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().where, "phase_margin_deg");
    EXPECT_THAT(answer.error().message, testing::HasSubstr("phase margin closer to 90 (1 - 1/gain_margin) = 45"));
}

// Grimholt & Skogestad: with the defaults Ms is 1.43 to 1.75 from a pure dead time to an integrator.
TEST(ImprovedSimc, FollowsItsFormulasAndIsAsRobustAsItsSourceSays) {
    expect_settings(tuned("improved_simc", Fopdt{.K = 2, .T = 10, .L = 3}, kPI), 11 / 12.0, 11, 0);
    expect_settings(tuned("improved_simc", Fopdt{.K = 2, .T = 100, .L = 3}, kPI), 101 / 12.0, 24, 0);
    // Series 10/9, 10, 1.
    expect_settings(tuned("improved_simc", Fopdt{.K = 2, .T = 10, .L = 3}), 10 / 9.0 * 1.1, 11, 10 / 11.0);
    // Pure dead time: integral action and its lead form a PI controller.
    expect_settings(tuned("improved_simc", Fopdt{.K = 2, .T = 0, .L = 3}, kPI), 1 / 12.0, 1, 0);
    expect_settings(tuned("improved_simc", Fopdt{.K = 2, .T = 0, .L = 3}), 1 / 9.0, 1, 0);
    expect_settings(tuned("improved_simc", Ipdt{.K = 2, .L = 3}, kPI), 1 / 12.0, 24, 0);
    expect_settings(tuned("improved_simc", Ipdt{.K = 2, .L = 3}), 1 / 9.0 * (1 + 1 / 18.0), 19, 18 / 19.0);
    for (const Plant& plant : {Plant(Fopdt{.K = 1, .T = 0, .L = 1}), Plant(Fopdt{.K = 1, .T = 1, .L = 1}),
                               Plant(Fopdt{.K = 1, .T = 20, .L = 1}), Plant(Ipdt{.K = 1, .L = 1})})
        for (const std::string controller : {"PI", "PID"}) {
            const Given given{word("controller", controller), {"filter/Tf_over_Td", 0.02}};
            const double Ms = *robustness_of(plant, tuned("improved_simc", plant, given)).Ms;
            EXPECT_GT(Ms, 1.42) << controller;
            EXPECT_LT(Ms, 1.75) << controller;
        }
}

struct KappaTauRow {
    const char *controller, *Ms;
    double a[3], Ti[3], Td[3], b[3];
};

TEST(KappaTau, ReproducesThePublishedTable) {
    const std::vector<KappaTauRow> rows{
        {"PI", "1.4", {0.29, -2.7, 3.7}, {8.9, -6.6, 3.0}, {0, 0, 0}, {0.81, 0.73, 1.9}},
        {"PI", "2.0", {0.78, -4.1, 5.7}, {8.9, -6.6, 3.0}, {0, 0, 0}, {0.44, 0.78, -0.45}},
        {"PID", "1.4", {3.8, -8.4, 7.3}, {5.2, -2.5, -1.4}, {0.89, -0.37, -4.1}, {0.40, 0.18, 2.8}},
        {"PID", "2.0", {8.4, -9.6, 9.8}, {3.2, -1.5, -0.93}, {0.86, -1.9, -0.44}, {0.22, 0.65, 0.051}},
    };
    const auto curve = [](const double(&c)[3], double tau) { return c[0] * std::exp(c[1] * tau + c[2] * tau * tau); };
    for (const auto& row : rows)
        for (const double L : {1.0, 3.0}) {  // tau = 0.2, 0.43 with T = 4
            const double tau = L / (L + 4), a = 2 * L / 4;
            const auto answer = tuned("kappa_tau", Fopdt{.K = 2, .T = 4, .L = L},
                                      {word("controller", row.controller), word("table_Ms", row.Ms)});
            expect_settings(answer, curve(row.a, tau) / a, curve(row.Ti, tau) * L, curve(row.Td, tau) * L);
            EXPECT_NEAR(answer->controller.b, std::min(1.0, curve(row.b, tau)), 1e-12);
        }
}

// The same curves, also printed in the source as Ti/T and Td/T, agree within their two digits.
TEST(KappaTau, AgreesWithItsSecondPrintedForm) {
    for (const double tau : {0.3, 0.5, 0.7}) {
        const double L = 1, T = L * (1 - tau) / tau;
        const auto pi = tuned("kappa_tau", Fopdt{.K = 1, .T = T, .L = L}, kPI);
        EXPECT_NEAR(pi->controller.Ti, T * 0.79 * std::exp(-1.4 * tau + 2.4 * tau * tau), 0.15 * pi->controller.Ti);
        const auto pid = tuned("kappa_tau", Fopdt{.K = 1, .T = T, .L = L});
        EXPECT_NEAR(pid->controller.Ti, T * 0.46 * std::exp(2.8 * tau - 2.1 * tau * tau), 0.15 * pid->controller.Ti);
    }
}

TEST(KappaTau, HasAboutTheMsOfItsTable) {
    for (const double L : {0.5, 1.0, 2.0, 4.0}) {
        const Fopdt plant{.K = 1, .T = 1, .L = L};
        const double pi = *robustness_of(plant, tuned("kappa_tau", plant, kPI)).Ms;
        EXPECT_GT(pi, 1.2) << L;
        EXPECT_LT(pi, 1.45) << L;
        const double pid = *robustness_of(plant, tuned("kappa_tau", plant)).Ms;
        EXPECT_GT(pid, 1.2) << L;
        EXPECT_LT(pid, 1.5) << L;
    }
}

TEST(AmigoUltimate, KeepsMsNear1Point4OnStablePlants) {
    for (const double L : {0.2, 0.5, 1.0, 4.0})
        for (const std::string controller : {"PI", "PID"}) {
            const Fopdt plant{.K = 1, .T = 1, .L = L};
            const double Ms =
                *robustness_of(plant, tuned("amigo_ultimate", plant, {word("controller", controller)})).Ms;
            EXPECT_GT(Ms, 1.3) << controller << L;
            EXPECT_LT(Ms, 1.6) << controller << L;
        }
}

}  // namespace
}  // namespace tunewright
