// Revised IMC: the properties of its branch, the results and refusals of its targets, and the full controller compared
// with its PID.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/evaluation/evaluate.h"
#include "engine/request/tune.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/rimc/rimc_branch.h"
#include "engine/tuning/rimc/rimc_report.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

using Given = std::vector<std::pair<std::string, OptionValue>>;

Expected<TunedController> rimc_tuned(const Plant& plant, const Given& given, const char* id = "rimc") {
    MethodOptions options;
    for (const auto& [path, value] : given) options.set(path, value);
    return find_method(id)->tune({plant, *LinearPlant::make(plant), std::nullopt}, options, {});
}

Evaluation evaluated(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions options;
    options.points = 0;
    return *evaluate(plant, pid, options);
}

bool rimc_warns(const TunedController& answer, const std::string& code) {
    return std::ranges::any_of(answer.warnings, [&](const Warning& w) { return w.code == code; });
}

const Fopdt kModels[] = {{1, 1, 0.1}, {2.5, 20, 10}, {-0.4, 3, 3}, {1e4, 1e-3, 2e-3}};

TEST(Rimc, FiguresAreThoseOfTheLoopOnTheModel) {
    for (const Fopdt& model : kModels) {
        for (const double Tf_over_Td : {0.0, 0.1}) {
            const auto answer = rimc_tuned(model, {{"lambda", 0.7 * model.T}, {"Tf_over_Td", Tf_over_Td}});
            ASSERT_TRUE(answer) << answer.error().message;
            const Evaluation e = evaluated(model, answer->controller);
            EXPECT_NEAR(*answer->report_as<RimcReport>()->Ms / *e.robustness.Ms, 1, 1e-9);
            EXPECT_NEAR(*answer->report_as<RimcReport>()->disturbance_peak / *e.performance.load.peak, 1, 1e-5);
        }
    }
}

TEST(Rimc, ATargetIsMetByTheReturnedPid) {
    for (const Fopdt& model : kModels) {
        const auto by_Ms = rimc_tuned(model, {{"Ms", 1.5}});
        ASSERT_TRUE(by_Ms) << by_Ms.error().message;
        EXPECT_NEAR(*evaluated(model, by_Ms->controller).robustness.Ms, 1.5, 1.5e-6);
        EXPECT_NEAR(*by_Ms->report_as<RimcReport>()->Ms, 1.5, 1.5e-6);

        const double peak = *RimcBranch(model, {}).disturbance_peak(0.9 * model.T);
        const auto by_peak = rimc_tuned(model, {{"disturbance_peak", peak}});
        ASSERT_TRUE(by_peak) << by_peak.error().message;
        EXPECT_NEAR(*evaluated(model, by_peak->controller).performance.load.peak / peak, 1, 1e-5);
        EXPECT_NEAR(by_peak->report_as<RimcReport>()->controller.lambda / model.T, 0.9, 1e-5);

        const auto by_error = rimc_tuned(model, {{"dead_time_error", 0.3 * model.L}});
        ASSERT_TRUE(by_error) << by_error.error().message;
        EXPECT_DOUBLE_EQ(*by_error->report_as<RimcReport>()->dead_time_error, 0.3 * model.L);
        // Eq. 29 is sufficient: the loop tolerates the error, and the margin is not smaller.
        EXPECT_GT(*evaluated(model, by_error->controller).robustness.delay_margin, 0.3 * model.L);
    }
}

TEST(Rimc, OfALambdaTheToleratedErrorIsWhereEquation29Ends) {
    for (const Fopdt& model : kModels) {
        const RimcBranch branch(model, {});
        const double lambda = 0.8 * model.T, error = *branch.dead_time_error(lambda);
        EXPECT_NEAR(*branch.dead_time_mismatch_at(lambda, error), 1, 1e-6);
        EXPECT_LT(*branch.dead_time_mismatch_at(lambda, 0.9 * error), 1);
        EXPECT_GT(*branch.dead_time_mismatch_at(lambda, 1.01 * error), 1);
    }
}

TEST(Rimc, ScalesWithTimeAndGain) {
    const auto unit = rimc_tuned(Fopdt{1, 1, 0.4}, {{"lambda", 0.6}});
    const auto scaled = rimc_tuned(Fopdt{-7, 300, 120}, {{"lambda", 180.0}});
    ASSERT_TRUE(unit && scaled);
    EXPECT_NEAR(scaled->controller.Kp / unit->controller.Kp, -1.0 / 7, 1e-12);
    EXPECT_NEAR(scaled->controller.Ti / unit->controller.Ti, 300, 1e-9);
    EXPECT_NEAR(scaled->controller.Td / unit->controller.Td, 300, 1e-9);
    EXPECT_NEAR(*scaled->report_as<RimcReport>()->disturbance_peak / *unit->report_as<RimcReport>()->disturbance_peak,
                -7, 1e-9);
    EXPECT_NEAR(*scaled->report_as<RimcReport>()->Ms, *unit->report_as<RimcReport>()->Ms, 1e-9);
    EXPECT_NEAR(*scaled->report_as<RimcReport>()->dead_time_error / *unit->report_as<RimcReport>()->dead_time_error,
                300, 1e-7);
    EXPECT_NEAR(*scaled->report_as<RimcReport>()->stability_limit / *unit->report_as<RimcReport>()->stability_limit,
                300, 1e-4);
}

TEST(Rimc, AlongTheBranchMsFallsAndThePeakRises) {
    for (const double L : {0.1, 0.5, 1.0, 2.0}) {
        const RimcBranch branch({1, 1, L}, {});
        ASSERT_TRUE(branch.branch());
        double last_Ms = 1e9, last_peak = 0;
        for (double lambda = 1.5 * branch.branch()->low; lambda < branch.branch()->high; lambda *= 1.1) {
            const double Ms = *branch.Ms(lambda), peak = *branch.disturbance_peak(lambda);
            EXPECT_LT(Ms, last_Ms * (1 + 1e-9)) << L << " " << lambda;
            EXPECT_GT(peak, last_peak * (1 - 2e-3)) << L << " " << lambda;
            last_Ms = Ms;
            last_peak = peak;
        }
    }
}

TEST(Rimc, TheBranchEndsWhereMsIsLeast) {
    // Recomputed independently: smallest Ms and its lambda/T; for L/T = 2, Td < 0 from 2.44 on is reached first.
    const double cases[][3] = {{0.1, 1.04, 1.5}, {0.5, 1.16, 1.7}, {1, 1.25, 2.0}};
    for (const auto& [L, Ms, lambda] : cases) {
        const RimcBranch branch({1, 1, L}, {});
        EXPECT_NEAR(branch.min_Ms(), Ms, 0.005) << L;
        EXPECT_NEAR(branch.branch()->high, lambda, 0.06) << L;
    }
    const RimcBranch long_dead_time({1, 1, 2}, {});
    EXPECT_NEAR(long_dead_time.admissible().high, 2.43, 0.01);
    EXPECT_DOUBLE_EQ(long_dead_time.branch()->high, long_dead_time.admissible().high);
    const RimcBranch short_dead_time({1, 1, 0.1}, {});
    EXPECT_NEAR(short_dead_time.admissible().high, 2.03, 0.02);
}

TEST(Rimc, WhatIsOutOfReachIsRefusedWithTheRange) {
    const Fopdt model{.K = 2, .T = 10, .L = 5};
    const auto Ms = rimc_tuned(model, {{"Ms", 1.1}});
    ASSERT_FALSE(Ms);
    EXPECT_EQ(Ms.error().kind, ErrorKind::no_feasible_controller);
    EXPECT_EQ(Ms.error().where, "Ms");
    EXPECT_THAT(Ms.error().message,
                HasSubstr("Ms is 1.1; on the model with L/T = 0.5 it can be 1.158 (at lambda = 16.7"));

    const auto low = rimc_tuned(model, {{"disturbance_peak", 0.7}});
    ASSERT_FALSE(low);
    EXPECT_THAT(low.error().message, HasSubstr("disturbance_peak is 0.7"));
    EXPECT_THAT(low.error().message, HasSubstr("no controller has less than 0.7869"));
    const auto high = rimc_tuned(model, {{"disturbance_peak", 1.9}});
    ASSERT_FALSE(high);
    EXPECT_THAT(high.error().message, HasSubstr("it can be from 0.79"));
    EXPECT_EQ(high.error().where, "disturbance_peak");
    const auto sign = rimc_tuned(model, {{"disturbance_peak", -1.0}});
    ASSERT_FALSE(sign);
    EXPECT_EQ(sign.error().kind, ErrorKind::invalid_argument);

    const auto error = rimc_tuned(model, {{"dead_time_error", 60.0}});
    ASSERT_FALSE(error);
    EXPECT_THAT(error.error().message, HasSubstr("by Eq. 29 on the model with L/T = 0.5 it can be up to"));

    const auto lambda = rimc_tuned(model, {{"lambda", 22.0}});
    ASSERT_FALSE(lambda);
    EXPECT_THAT(lambda.error().message,
                HasSubstr("lambda is 22; a PID with K Kp > 0 and Td >= 0 exists for lambda up to 21.2"));

    const auto both = rimc_tuned(model, {{"lambda", 5.0}, {"Ms", 1.5}});
    ASSERT_FALSE(both);
    EXPECT_THAT(both.error().message, HasSubstr("lambda and Ms are both given"));
}

TEST(Rimc, PlantsWithoutASlowPoleAreRefusedWithACure) {
    const auto integrating = rimc_tuned(Ipdt{.K = 1, .L = 1}, {});
    ASSERT_FALSE(integrating);
    EXPECT_EQ(integrating.error().kind, ErrorKind::unsupported);
    EXPECT_THAT(integrating.error().message, HasSubstr("Use simc, amigo, lambda or robust."));
    const auto dead = rimc_tuned(Fopdt{.K = 1, .T = 0, .L = 1}, {});
    ASSERT_FALSE(dead);
    EXPECT_THAT(dead.error().message, HasSubstr("pure dead time"));
    const auto unstable = rimc_tuned(Fopdt{.K = 1, .T = -1, .L = 0.1}, {});
    ASSERT_FALSE(unstable);
    EXPECT_THAT(unstable.error().message, HasSubstr("unstable"));
}

TEST(Rimc, WithoutDeadTimeItIsThePiControllerOfEquation23) {
    const auto answer = rimc_tuned(Fopdt{.K = 2, .T = 5, .L = 0}, {{"lambda", 2.0}});
    ASSERT_TRUE(answer) << answer.error().message;
    const double beta = 5 * (1 - 0.6 * 0.6);  // C = (beta s + 1) T/(K lambda^2 s)
    EXPECT_NEAR(answer->controller.Kp, beta * 5 / (2 * 4), 1e-12);
    EXPECT_NEAR(answer->controller.Ti, beta, 1e-12);
    EXPECT_EQ(answer->controller.Td, 0);
    EXPECT_EQ(answer->controller.filter.type, FilterType::none);
    EXPECT_NEAR(*answer->report_as<RimcReport>()->Ms, 1, 1e-9);
}

TEST(Rimc, OtherPlantsAreReducedAndTheModelIsShown) {
    const auto answer = rimc_tuned(Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1}, {{"Ms", 1.6}});
    ASSERT_TRUE(answer) << answer.error().message;
    ASSERT_TRUE(answer->reduced_model);
    const auto& model = std::get<Fopdt>(*answer->reduced_model);
    EXPECT_NEAR(model.T, 21, 1e-12);
    EXPECT_NEAR(model.L, 2, 1e-12);
    EXPECT_NEAR(*evaluated(model, answer->controller).robustness.Ms, 1.6, 2e-6);
}

TEST(Rimc, LinearFractionalIsTheSamePidWithTheFilterThatMatchesTheFourthTerm) {
    const Fopdt model{.K = 1, .T = 1, .L = 0.5};
    const auto plain = rimc_tuned(model, {{"lambda", 0.8}});
    const auto fraction = rimc_tuned(model, {{"lambda", 0.8}, {"approximation", std::string("linear_fractional")}});
    ASSERT_TRUE(plain && fraction);
    EXPECT_DOUBLE_EQ(fraction->controller.Kp, plain->controller.Kp);
    EXPECT_DOUBLE_EQ(fraction->controller.Td, plain->controller.Td);
    ASSERT_EQ(fraction->controller.filter.type, FilterType::derivative);
    // s C of the PID and of Eq. 23 at a small real s differ by the fifth term with the filter, by the fourth without.
    const auto defect = [&](const IdealPid& pid, double s) {
        const ImcController c = rimc_controller(model, 0.8);
        const double Q = c.Q(s).real(), full = Q / (1 - c.model(s).real() * Q);
        const double Tf = pid.filter.Tf;
        return s * (pid.Kp * (1 + 1 / (s * pid.Ti) + s * pid.Td / (1 + s * Tf)) - full);
    };
    EXPECT_NEAR(defect(fraction->controller, 0.04) / defect(fraction->controller, 0.02), 16, 1.5);
    IdealPid unfiltered = plain->controller;
    unfiltered.filter = {};
    EXPECT_NEAR(defect(unfiltered, 0.04) / defect(unfiltered, 0.02), 8, 1);

    const auto refused = rimc_tuned(model, {{"lambda", 0.2}, {"approximation", std::string("linear_fractional")}});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("a filter time > 0 exists for lambda from 0.4005"));
    const auto doubled = rimc_tuned(model, {{"Tf_over_Td", 0.1}, {"approximation", std::string("linear_fractional")}});
    ASSERT_FALSE(doubled);
    EXPECT_EQ(doubled.error().where, "Tf_over_Td");
}

TEST(Rimc, AnEasyTargetLeavesTheLinearFractionAFilter) {
    // A filter time of 0 would pass noise without limit: the filter is at least the paper's smallest ratio, 0.01.
    for (const double L : {0.5, 1.0, 3.0, 8.0}) {
        const Fopdt model{.K = 1, .T = 10, .L = L};
        const auto tuned =
            rimc_tuned(model, {{"dead_time_error", 0.05}, {"approximation", std::string("linear_fractional")}});
        ASSERT_TRUE(tuned) << L;
        const IdealPid& pid = tuned->controller;
        EXPECT_GE(pid.filter.Tf, 0.01 * pid.Td * (1 - 1e-6)) << L;
        const auto evaluation = evaluate(model, pid, {});
        ASSERT_TRUE(evaluation);
        EXPECT_TRUE(evaluation->performance.load.IAE) << L;
        EXPECT_GT(*evaluation->performance.load.peak, 1 - std::exp(-L / 10)) << "no controller acts before L";
    }
}

TEST(Rimc, WarnsNearTheLimitAndBeyondTheLeastMs) {
    const Fopdt model{.K = 1, .T = 1, .L = 0.5};
    const double limit = *RimcBranch(model, {}).stability_limit();
    EXPECT_TRUE(rimc_warns(*rimc_tuned(model, {{"lambda", 1.2 * limit}}), "near-stability-limit"));
    EXPECT_TRUE(rimc_warns(*rimc_tuned(model, {{"lambda", 0.9 * limit}}), "unstable-model-loop"));
    EXPECT_TRUE(rimc_warns(*rimc_tuned(model, {{"lambda", 1.9}}), "outside-validity"));
    EXPECT_TRUE(rimc_tuned(model, {})->warnings.empty());
    EXPECT_FALSE(rimc_tuned(model, {{"lambda", 0.9 * limit}})->report_as<RimcReport>()->Ms.has_value());
}

TEST(Rimc, TheCurveHoldsTheFiguresOfItsLambdas) {
    const Fopdt model{.K = -3, .T = 40, .L = 20};
    const auto answer = rimc_tuned(model, {{"curve", true}});
    ASSERT_TRUE(answer && answer->report_as<RimcReport>()->curve);
    const auto& curve = *answer->report_as<RimcReport>()->curve;
    ASSERT_EQ(curve.Ms.size(), 60u);
    ASSERT_EQ(curve.DP_over_kp.size(), 60u);
    const std::size_t i = 40;
    const auto one = rimc_tuned(model, {{"lambda", curve.lambda_over_tau[i] * model.T}});
    EXPECT_NEAR(*one->report_as<RimcReport>()->Ms, curve.Ms[i], 1e-9);
    EXPECT_NEAR(*one->report_as<RimcReport>()->disturbance_peak / model.K, curve.DP_over_kp[i], 1e-9);
    EXPECT_FALSE(rimc_tuned(model, {})->report_as<RimcReport>()->curve.has_value());
}

RimcReport entry_of(const Plant& plant, const Given& given, int points = 0) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = {{"rimc", {}}};
    for (const auto& [path, value] : given) request.tune[0].options.set(path, value);
    request.evaluate.points = points;
    const auto result = tune(request, {});
    EXPECT_TRUE(result) << result.error().message;
    return *result->controllers[0].report_as<RimcReport>();
}

TEST(Rimc, OnItsModelTheFullControllersLoopIsTheDesigns) {
    const Fopdt model{.K = 2, .T = 10, .L = 5};
    const RimcReport entry = entry_of(model, {{"lambda", 5.0}}, 200);
    ASSERT_TRUE(entry.full_controller);
    const auto& full = *entry.full_controller;
    EXPECT_TRUE(full.robustness.stable);
    // T = (beta s + 1) e^(-theta s)/(lambda s + 1)^2: |T| and the load response in closed form.
    const double beta = 10 * (1 - 0.25 * std::exp(-0.5));
    double Mt = 0;
    for (double omega = 1e-3; omega < 10; omega *= 1.0005)
        Mt = std::max(Mt, std::sqrt(1 + beta * beta * omega * omega) / (1 + 25 * omega * omega));
    EXPECT_NEAR(*full.robustness.Mt / Mt, 1, 1e-6);
    EXPECT_NEAR(*full.load.IAE, 2 * (2 * 5 + 5 - beta), 1e-4 * 2 * (2 * 5 + 5 - beta));  // y keeps its sign: the IE
    ASSERT_TRUE(full.responses);
    const auto& load = full.responses->load;
    const double a = 1.0 / 5;  // g: the plant's step, h: that of (beta s + 1)/((lambda s + 1)^2 (tau s + 1)), K apart
    for (std::size_t i = 0; i < load.t.size(); ++i) {
        const auto g = [](double t) { return t > 0 ? 1 - std::exp(-t / 10) : 0; };
        const auto h = [&](double t) {
            if (t <= 0) return 0.0;
            // Residues of (beta s + 1)/(s (5 s + 1)^2 (10 s + 1)) at 0, -1/10, and twice at -1/5.
            const double at_tau = (1 - beta / 10) / (-0.1 * 0.25 * 10);
            const auto numerator = 1 - beta * a, denominator = -a * (1 - 10 * a);
            const double slope = (beta * denominator - numerator * (1 - 20 * a)) / (denominator * denominator);
            return 1 + at_tau * std::exp(-t / 10) + (slope + numerator / denominator * t) / 25 * std::exp(-t * a);
        };
        EXPECT_NEAR(load.y[i], 2 * (g(load.t[i] - 5) - h(load.t[i] - 10)), 2e-6) << load.t[i];
    }
}

TEST(Rimc, OnAnotherPlantTheFullControllersStabilityAgreesWithItsResponse) {
    const Sopdt plant{.K = 1, .T1 = 20, .T2 = 2, .L = 1};
    const RimcReport entry = entry_of(plant, {{"Ms", 1.6}}, 100);
    ASSERT_TRUE(entry.full_controller);
    EXPECT_TRUE(entry.full_controller->robustness.stable);
    ASSERT_TRUE(entry.full_controller->responses);
    EXPECT_TRUE(entry.full_controller->responses->settles);
    // The integral of y is the inverse of the integral gain, for the PID and the full controller alike; IAE is not
    // smaller.
    const auto pid = rimc_tuned(plant, {{"Ms", 1.6}})->controller;
    EXPECT_GE(*entry.full_controller->load.IAE, pid.Ti / pid.Kp * (1 - 1e-6));
    EXPECT_LT(*entry.full_controller->load.IAE, 1.2 * pid.Ti / pid.Kp);
}

TEST(Rimc, AFullControllerThatTheModelsErrorMakesUnstableSaysSo) {
    const RimcReport entry = entry_of(Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1}, {{"lambda", 0.3}});
    ASSERT_TRUE(entry.full_controller);
    EXPECT_FALSE(entry.full_controller->robustness.stable);
    EXPECT_FALSE(entry.full_controller->load.IAE.has_value());
    EXPECT_FALSE(entry.full_controller->load.IAE.why.empty());
}

TEST(Imc, MaclaurinAndPadeAgreeWithTheirFormulas) {
    const Fopdt model{.K = -2, .T = 10, .L = 3};
    const auto pade = rimc_tuned(model, {{"lambda", 4.0}, {"expansion", std::string("pade")}}, "imc");
    ASSERT_TRUE(pade) << pade.error().message;
    EXPECT_NEAR(pade->controller.Kp, (2 * 10 + 3) / (-2 * (2 * 4.0 + 3)), 1e-12);
    EXPECT_NEAR(pade->controller.Ti, 11.5, 1e-12);
    EXPECT_NEAR(pade->controller.Td, 30.0 / 23, 1e-12);
    EXPECT_NEAR(pade->controller.filter.Tf, 3.0 / 23, 1e-12);

    // C = (T s + 1)/(K (lambda s + 1 - e^(-L s))) and the PID differ by the fourth term.
    const auto series = rimc_tuned(model, {{"lambda", 4.0}, {"filter/Tf_over_Td", 0.0}}, "imc");
    ASSERT_TRUE(series);
    const auto defect = [&](double s) {
        const IdealPid& c = series->controller;
        return s * (c.Kp * (1 + 1 / (s * c.Ti) + s * c.Td) - (10 * s + 1) / (-2 * (4 * s - std::expm1(-3 * s))));
    };
    EXPECT_NEAR(defect(4e-3) / defect(2e-3), 8, 0.1);
}

TEST(Imc, OscillatoryPlantsAreTheirOwnModel) {
    const OscillatorySopdt plant{.K = 1, .T = 2, .zeta = 0.3, .L = 1};
    const auto answer =
        rimc_tuned(plant, {{"lambda", 1.0}, {"expansion", std::string("pade")}, {"filter_order", 1.0}}, "imc");
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_FALSE(answer->reduced_model);
    EXPECT_NEAR(answer->controller.Kp, 1.2 / 2, 1e-12);  // 2 zeta T/(K (lambda + L))
    EXPECT_NEAR(answer->controller.Ti, 1.2, 1e-12);
    EXPECT_NEAR(answer->controller.Td, 4 / 1.2, 1e-12);
}

TEST(Imc, RefusesWhatItsFilterCannotServe) {
    const auto integrating = rimc_tuned(Ipdt{.K = 1, .L = 1}, {}, "imc");
    ASSERT_FALSE(integrating);
    EXPECT_EQ(integrating.error().kind, ErrorKind::unsupported);
    const auto no_lambda = rimc_tuned(Fopdt{.K = 1, .T = 0, .L = 0}, {}, "imc");
    EXPECT_FALSE(no_lambda);
    const auto too_slow = rimc_tuned(Fopdt{.K = 1, .T = 1, .L = 1}, {{"lambda", 50.0}, {"filter_order", 2.0}}, "imc");
    ASSERT_FALSE(too_slow);
    EXPECT_THAT(too_slow.error().message, HasSubstr("Use a smaller lambda, or filter_order 1."));
}

}  // namespace
}  // namespace tunewright
