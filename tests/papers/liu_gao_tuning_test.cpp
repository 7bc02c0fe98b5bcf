// Liu and Gao (2008): the tuning part. Table 2, Example 3's responses, Fig. 2 and the robust-stability bounds, compared
// with the printed figures and independently recomputed ones (tests/data/relay_tuning).
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/evaluation/evaluate.h"
#include "engine/request/tune.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/rimc/rimc_report.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

const Json& reference() {
    static const Json json = Json::parse(std::ifstream(test_data("relay_tuning/liu_gao.json")));
    return json;
}

const Fopdt kModel{.K = 0.98, .T = 21.8291, .L = 2.7993};       // as printed for Example 3
const Sopdt kProcess{.K = 1, .T1 = 20, .T2 = 2, .L = 1};        // G3
const Sopdt kPerturbed{.K = 1, .T1 = 16, .T2 = 1.6, .L = 1.2};  // dead time 20 % larger, lags 20 % smaller

Expected<TunedController> tuned(const char* method, const Plant& plant,
                                const std::vector<std::pair<const char*, OptionValue>>& given) {
    MethodOptions options;
    for (const auto& [name, value] : given) options.set(name, value);
    return find_method(method)->tune(TuningProblem{plant, *LinearPlant::make(plant), std::nullopt}, options, {});
}

IdealPid proposed() { return tuned("rimc", kModel, {{"lambda", 0.9}, {"Tf_over_Td", 0.0}})->controller; }
IdealPid skogestad() { return tuned("simc", kProcess, {{"tau_c", 1.0}, {"filter/Tf_over_Td", 0.0}})->controller; }
IdealPid imc() { return tuned("imc", kProcess, {{"lambda", 0.45}, {"filter/Tf_over_Td", 0.0}})->controller; }

IdealPid of_row(const std::string& name) {
    return name == "proposed" ? proposed() : name == "imc" ? imc() : skogestad();
}

Evaluation evaluated(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions options;
    options.points = 0;
    const auto evaluation = evaluate(plant, pid, options);
    EXPECT_TRUE(evaluation.has_value());
    return *evaluation;
}

/// k_c, tau_i (the inverse integral gain), tau_d (the derivative gain): Eq. 26.
std::array<double, 3> as_printed(const IdealPid& pid) { return {pid.Kp, pid.Ti / pid.Kp, pid.Td * pid.Kp}; }

TEST(LiuGao, Table2ComesOutToEveryPrintedDigit) {
    for (const auto& [name, row] : reference()["table2"]["rows"].items()) {
        const auto settings = as_printed(of_row(name));
        for (std::size_t i = 0; i < 3; ++i) {
            const double printed = row["published"][i];
            // Half a unit of the last printed digit.
            const double digits = i == 0 || i == 1 ? 0.5e-4 : name == "proposed" ? 0.5e-3 : 0.5e-4;
            EXPECT_NEAR(settings[i], printed, digits) << name << " " << i;
            EXPECT_NEAR(settings[i] / row["recomputed"][i].get<double>(), 1, 1e-5) << name << " " << i;
        }
    }
}

TEST(LiuGao, RecoveryTimesGiveThePapersReductions) {
    const auto recovery = [](const IdealPid& pid) { return *evaluated(kProcess, pid).performance.load.recovery_time; };
    const double ours = recovery(proposed()), skogestads = recovery(skogestad()), imcs = recovery(imc());
    EXPECT_NEAR(ours / 17.0, 1, 0.01);
    EXPECT_NEAR(skogestads / 33.9, 1, 0.01);
    EXPECT_NEAR(imcs / 87.8, 1, 0.01);
    EXPECT_NEAR(1 - ours / imcs, 0.80, 0.01);        // "almost 80 percent"
    EXPECT_NEAR(1 - ours / skogestads, 0.50, 0.01);  // "almost 50 percent"
}

TEST(LiuGao, Example3RespondsAsRecomputedAlsoOnThePerturbedPlant) {
    const Json& tolerance = reference()["tolerance_response"];
    int unstable = 0;
    for (const Json& row : reference()["example3_disturbance"]) {
        IdealPid pid = of_row(row["tuning"]);
        const double Tf = row["T_f"];
        pid.filter = Tf > 0 ? Filter{FilterType::derivative, Tf} : Filter{};
        const std::string which = row.dump();
        const Plant plant = row["plant"] == "nominal" ? kProcess : kPerturbed;
        const Evaluation e = evaluated(plant, pid);
        ASSERT_EQ(e.robustness.stable, row["stable"].get<bool>()) << which;
        if (!e.robustness.stable) ++unstable;
        if (!row.contains("Ms")) continue;
        const auto& load = e.performance.load;
        EXPECT_NEAR(*e.robustness.Ms / row["Ms"].get<double>(), 1, tolerance["Ms_rel"]) << which;
        EXPECT_NEAR(*e.robustness.Mt / row["Mt"].get<double>(), 1, tolerance["Ms_rel"]) << which;
        EXPECT_NEAR(*e.robustness.delay_margin / row["delay_margin"].get<double>(), 1, 0.002) << which;
        EXPECT_NEAR(*load.peak / row["peak"].get<double>(), 1, tolerance["peak_rel"]) << which;
        EXPECT_NEAR(*load.IAE / row["IAE"].get<double>(), 1, tolerance["IAE_rel"]) << which;
        EXPECT_NEAR(*load.recovery_time / row["rec_2pct_peak"].get<double>(), 1, tolerance["recovery_rel"]) << which;
    }
    EXPECT_EQ(unstable, 2);
}

TEST(LiuGao, Figure2ComesOutForThePid) {
    const double tolerance = reference()["fig2_tolerance_abs"];
    for (const Json& row : reference()["fig2_dp_over_kp"]) {
        const Fopdt plant{.K = 2, .T = 5, .L = 5 * row["theta_tau"].get<double>()};
        for (const bool filtered : {false, true}) {
            const auto answer = tuned(
                "rimc", plant, {{"lambda", 5 * row["lam_tau"].get<double>()}, {"Tf_over_Td", filtered ? 0.1 : 0.0}});
            ASSERT_TRUE(answer.has_value()) << row << answer.error().message;
            const auto& peak = answer->report_as<RimcReport>()->disturbance_peak;
            const Json& expected = row[filtered ? "dp_pid_filtered" : "dp_pid_ideal_derivative"];
            if (expected.is_null()) continue;  // unstable, or not settled when it was recomputed
            ASSERT_TRUE(peak.has_value()) << row;
            EXPECT_NEAR(*peak / plant.K, expected, tolerance) << row;
        }
    }
}

TEST(LiuGao, Figure2ComesOutForTheFullController) {
    for (const Json& row : reference()["fig2_dp_over_kp"]) {
        TuningRequest request;
        request.subject = test::subject_of(Fopdt{.K = 1, .T = 1, .L = row["theta_tau"]});
        request.tune = {{"rimc", {}}};
        request.tune[0].options.set("lambda", row["lam_tau"].get<double>());
        request.evaluate.points = 0;
        const auto result = tune(request, {});
        ASSERT_TRUE(result.has_value()) << row << result.error().message;
        EXPECT_NEAR(*result->controllers[0].report_as<RimcReport>()->full_controller->load.peak,
                    row["dp_exact_controller"], 1e-6)
            << row;
    }
}

TEST(LiuGao, RobustStabilityBoundsHoldWithinHalfAPercent) {
    const double tolerance = reference()["robust_tolerance_rel"];
    for (const Json& row : reference()["robust_lambda_min"]) {
        const Fopdt plant{row["kp"], row["tau"], row["theta"]};
        for (const bool filtered : {false, true}) {
            const auto answer =
                tuned("rimc", plant,
                      {{"dead_time_error", row["dtheta"].get<double>()}, {"Tf_over_Td", filtered ? 0.1 : 0.0}});
            ASSERT_TRUE(answer.has_value()) << row << answer.error().message;
            const double expected = row[filtered ? "lam_min_pid_filtered_0p1" : "lam_min_pid_ideal_derivative"];
            EXPECT_NEAR(answer->report_as<RimcReport>()->controller.lambda / expected, 1, tolerance) << row;
        }
    }
}

TEST(LiuGao, LimitsOfTheModelLoopAreWhereTheyWereRecomputed) {
    for (const Json& row : reference()["model_loop_limits"]) {
        const Fopdt plant{.K = 1, .T = 1, .L = row["theta_tau"]};
        for (const double Ms : {2.0, 1.6}) {
            const auto answer = tuned("rimc", plant, {{"Ms", Ms}});
            ASSERT_TRUE(answer.has_value()) << row << answer.error().message;
            const double expected = row[Ms == 2 ? "lam_Ms_2p0" : "lam_Ms_1p6"];
            EXPECT_NEAR(answer->report_as<RimcReport>()->controller.lambda / expected, 1, 1e-4) << row;
        }
        for (const bool filtered : {false, true}) {
            const auto answer = tuned("rimc", plant, {{"Tf_over_Td", filtered ? 0.1 : 0.0}});
            const double expected = row[filtered ? "lam_stable_filtered_0p1" : "lam_stable_ideal_derivative"];
            EXPECT_NEAR(*answer->report_as<RimcReport>()->stability_limit / expected, 1, 0.005) << row;
        }
    }
}

TEST(LiuGao, ThePrintedLambdaIsUnstableOnItsOwnModelWithTheFilterAndSaysSo) {
    const auto filtered = tuned("rimc", kModel, {{"lambda", 0.9}});
    ASSERT_TRUE(filtered.has_value());
    EXPECT_FALSE(filtered->report_as<RimcReport>()->Ms.has_value());
    EXPECT_NEAR(*filtered->report_as<RimcReport>()->stability_limit / kModel.T, 0.0417, 5e-5);
    ASSERT_EQ(filtered->warnings.size(), 1u);
    EXPECT_EQ(filtered->warnings[0].code, "unstable-model-loop");
    EXPECT_NE(filtered->warnings[0].detail.find("0.04123"), std::string::npos);
    EXPECT_NE(filtered->warnings[0].detail.find("0.04168"), std::string::npos);

    const auto ideal = tuned("rimc", kModel, {{"lambda", 0.9}, {"Tf_over_Td", 0.0}});
    EXPECT_NEAR(*ideal->report_as<RimcReport>()->stability_limit / kModel.T, 0.0362, 5e-5);
    ASSERT_EQ(ideal->warnings.size(), 1u);
    EXPECT_EQ(ideal->warnings[0].code, "near-stability-limit");
}

}  // namespace
}  // namespace tunewright
