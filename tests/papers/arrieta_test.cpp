// Arrieta, Vilanova and Alfaro (2012): Tables 3 and 4, the rule's robustness over L/T, its optima and degradations,
// compared with the printed figures and independently recomputed ones (tests/data/servo_regulation).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/evaluation/evaluate.h"
#include "engine/reduction/reduction.h"
#include "engine/request/tune.h"
#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/arrieta/tradeoff_report.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

const Json& reference() {
    static const Json json = Json::parse(std::ifstream(test_data("servo_regulation/arrieta.json")));
    return json;
}

const Fopdt kModel{.K = 1, .T = 1.247, .L = 0.691};                           // as printed
const Zpk kProcess{.K = 64, .zeros = {}, .poles = {-1, -2, -4, -8}, .L = 0};  // Eq. 12, sigma = 0.5
const char* const kLevels[] = {"0.25", "0.35", "0.45", "0.55"};

Fopdt scaled_model(const std::string& tau) { return {.K = 1, .T = 1, .L = std::stod(tau)}; }

MethodRequest request(const char* method, const std::vector<std::pair<const char*, OptionValue>>& given) {
    MethodRequest out{.method = method, .options = {}};
    for (const auto& [name, value] : given) out.options.set(name, value);
    return out;
}

TuningEntry entry(const Plant& plant, const MethodRequest& method) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = {method};
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return result ? result->controllers.front() : TuningEntry{};
}

TuningEntry by_degradation(const Plant& plant, double degradation, bool exact = false) {
    auto method = request("arrieta_degradation", {{"degradation", degradation}});
    if (exact) method.options.set("exact", true);
    return entry(plant, method);
}

const IdealPid& pid_of(const TuningEntry& entry) { return std::get<IdealPid>(entry.evaluation->controller); }

double Ms_with(const Fopdt& model, const ArrietaConstants& constants) {
    EvaluateOptions options;
    options.points = 0;
    return *evaluate(model, arrieta_pid(constants, model), options)->robustness.Ms;
}

ArrietaConstants constants_of(const Json& row) {
    return {row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]};
}

TEST(Arrieta, Table3FollowsFromTheProcessAndFromThePrintedModel) {
    const auto model =
        reduce(*LinearPlant::make(kProcess), {.order = ReducedOrder::first, .method = ReductionMethod::two_point_123c});
    ASSERT_TRUE(model);
    EXPECT_NEAR(model->T1, 1.247, 5.1e-4);
    EXPECT_NEAR(model->L, 0.691, 5.1e-4);
    for (const char* level : kLevels) {
        const Json& row = reference()["table3"][level];
        const IdealPid on_process = pid_of(by_degradation(kProcess, std::stod(level)));
        const IdealPid on_model = pid_of(by_degradation(kModel, std::stod(level)));
        const std::array<std::array<double, 2>, 3> settings = {
            {{on_process.Kp, on_model.Kp}, {on_process.Ti, on_model.Ti}, {on_process.Td, on_model.Td}}};
        for (std::size_t i = 0; i < 3; ++i) {
            // The paper rounded its model, which moves Kp by 4e-4.
            EXPECT_NEAR(settings[i][0], row["published"][i].get<double>(), 1e-3) << level << " " << i;
            EXPECT_NEAR(settings[i][1], row["published"][i].get<double>(), 5.1e-4) << level << " " << i;
            EXPECT_NEAR(settings[i][1] / row["recomputed"][i].get<double>(), 1, 1e-6) << level << " " << i;
        }
        EXPECT_EQ(on_model.b, 1);
        EXPECT_EQ(on_model.c, 0);
        EXPECT_EQ(on_model.filter.type, FilterType::derivative);
        EXPECT_DOUBLE_EQ(on_model.filter.Tf, on_model.Td / 10);
    }
}

// The printed table has robustness and degradation for the model, the errors for the process.
TEST(Arrieta, Table4ComesOutWithEachColumnOnItsPlant) {
    for (const char* level : kLevels) {
        const Json& row = reference()["table4"][level]["published"];
        const auto answer = by_degradation(kProcess, std::stod(level));
        ASSERT_TRUE(answer.report_as<TradeoffReport>());
        const TradeoffFigures &model = answer.report_as<TradeoffReport>()->model,
                              &plant = answer.report_as<TradeoffReport>()->plant;
        EXPECT_NEAR(*model.Ms / row["Ms_r"].get<double>(), 1, 5e-4) << level;
        EXPECT_NEAR(*model.Deg, row["Deg_r"].get<double>(), 1e-3) << level;
        EXPECT_NEAR(*plant.J_r / row["J_r"].get<double>(), 1, 5e-4) << level;
        EXPECT_NEAR(*plant.J_d / row["J_d"].get<double>(), 1, 1e-3) << level;
        EXPECT_NEAR(*plant.J_rd / row["J_rd"].get<double>(), 1, 2e-2) << level;
        // The entry's own figures are those of the process.
        EXPECT_NEAR(*answer.evaluation->robustness.Ms / *plant.Ms, 1, 1e-9);
        EXPECT_NEAR(*answer.evaluation->performance.setpoint.IAE / *plant.J_r, 1, 1e-4);
        EXPECT_NEAR(*answer.evaluation->performance.load.IAE / *plant.J_d, 1, 1e-4);
    }
}

TEST(Arrieta, EveryFigureOfTheExampleOnBothPlantsAgreesWithTheRecomputedOnes) {
    for (const char* level : kLevels) {
        const Json& all = reference()["table4"][level]["all"];
        const auto on_model = by_degradation(kModel, std::stod(level));
        const TradeoffFigures& f = on_model.report_as<TradeoffReport>()->model;
        EXPECT_NEAR(*f.Ms / all["model"]["Ms"].get<double>(), 1, 1e-5);
        EXPECT_NEAR(*f.J_r / all["model"]["Jr"].get<double>(), 1, 1e-4);
        EXPECT_NEAR(*f.J_d / all["model"]["Jd"].get<double>(), 1, 1e-4);
        EXPECT_NEAR(*f.J_rd / all["model"]["Jrd"].get<double>(), 1, 1e-3);
        EXPECT_NEAR(*f.Deg, all["model"]["Deg"].get<double>(), 5e-4);
        const auto on_process = by_degradation(kProcess, std::stod(level));
        const TradeoffFigures& g = on_process.report_as<TradeoffReport>()->plant;
        EXPECT_NEAR(*g.Ms / all["process"]["Ms"].get<double>(), 1, 1e-3);
        EXPECT_NEAR(*g.J_r / all["process"]["Jr"].get<double>(), 1, 1e-3);
        EXPECT_NEAR(*g.J_d / all["process"]["Jd"].get<double>(), 1, 1e-3);
        EXPECT_NEAR(*g.Deg, all["process"]["Deg"].get<double>(), 2e-3);
    }
}

TEST(Arrieta, ConstantsAreThoseOfThePrintedTables) {
    const auto expect_same = [](const ArrietaConstants& ours, const ArrietaConstants& printed) {
        const Fopdt model{.K = 2, .T = 3, .L = 1.7};
        const IdealPid a = arrieta_pid(ours, model), b = arrieta_pid(printed, model);
        EXPECT_DOUBLE_EQ(a.Kp, b.Kp);
        EXPECT_DOUBLE_EQ(a.Ti, b.Ti);
        EXPECT_DOUBLE_EQ(a.Td, b.Td);
    };
    expect_same(arrieta_free(), constants_of(reference()["table1"]["free"]));
    for (const ArrietaLevel& column : arrieta_Ms_levels()) {
        char name[8];
        std::snprintf(name, sizeof name, "%.1f", column.level);
        expect_same(column.constants, constants_of(reference()["table1"][name]));
    }
    for (const auto& [name, row] : reference()["table2"].items()) {
        const auto* column = arrieta_column(arrieta_degradation_levels(), std::stod(name));
        ASSERT_NE(column, nullptr) << name;
        expect_same(*column, constants_of(row));
    }
}

TEST(Arrieta, RobustnessOfTable1AndOfEquation9AgreesWithTheRecomputedOne) {
    for (const auto& [tau, row] : reference()["tau_scan"].items()) {
        const Fopdt model = scaled_model(tau);
        for (const auto& [Ms, value] : row["Ms_table1"].items())
            EXPECT_NEAR(Ms_with(model, *arrieta_column(arrieta_Ms_levels(), std::stod(Ms))) / value.get<double>(), 1,
                        1e-3)
                << tau << " " << Ms;
        for (const auto& [Ms, value] : row["Ms_eq9_b3"].items())
            EXPECT_NEAR(Ms_with(model, arrieta_equation_9(std::stod(Ms), ArrietaC3::printed)) / value.get<double>(), 1,
                        1e-3)
                << tau << " " << Ms;
        for (const auto& [Ms, value] : row["Ms_eq9_b3_c3"].items())
            EXPECT_NEAR(Ms_with(model, arrieta_equation_9(std::stod(Ms), ArrietaC3::refitted)) / value.get<double>(), 1,
                        1e-3)
                << tau << " " << Ms;
    }
}

TEST(Arrieta, TheMethodTakesTheTableAtItsLevelsAndEquation9InBetween) {
    for (const auto& [tau, row] : reference()["tau_scan"].items()) {
        const auto at_level = entry(scaled_model(tau), request("arrieta_ms", {{"Ms", 1.6}}));
        EXPECT_NEAR(*at_level.evaluation->robustness.Ms / row["Ms_table1"]["1.6"].get<double>(), 1, 1e-3);
        EXPECT_EQ(*at_level.report_as<TradeoffReport>()->constants, "Table 1, column Ms = 1.6");
        const auto between = entry(scaled_model(tau), request("arrieta_ms", {{"Ms", 1.7}}));
        EXPECT_NEAR(*between.evaluation->robustness.Ms / row["Ms_eq9_b3_c3"]["1.7"].get<double>(), 1, 1e-3);
        EXPECT_EQ(between.report_as<TradeoffReport>()->constants->substr(0, 16), "Eq. 9 at Ms = 1.");
        EXPECT_TRUE(between.report_as<TradeoffReport>()->constants->ends_with(
            "c3 = 0.1331 M^2 - 0.4320 M + 0.3330 (the quadratic "
            "through Table 1)"));
        EXPECT_EQ(*between.report_as<TradeoffReport>()->Ms_design, 1.7);
        const auto printed =
            entry(scaled_model(tau), request("arrieta_ms", {{"Ms", 1.7}, {"c3", std::string("printed")}}));
        EXPECT_NEAR(*printed.evaluation->robustness.Ms / row["Ms_eq9_b3"]["1.7"].get<double>(), 1, 1e-3);
        EXPECT_TRUE(printed.report_as<TradeoffReport>()->constants->ends_with("c3 as printed"));
        const auto free = entry(scaled_model(tau), request("arrieta_ms", {{"Ms", std::string("free")}}));
        EXPECT_NEAR(*free.evaluation->robustness.Ms / row["free"]["Ms"].get<double>(), 1, 1e-3);
        EXPECT_EQ(*free.report_as<TradeoffReport>()->model.I_perf, 1);
        EXPECT_FALSE(free.report_as<TradeoffReport>()->Ms_design);
    }
}

// The recomputed optima are accurate to 2e-4; a better result must not fail.
TEST(Arrieta, OptimaAndDegradationsOverTheRangeAgreeWithTheRecomputedOnes) {
    for (const auto& [tau, row] : reference()["tau_scan"].items()) {
        for (const auto& [level, Deg] : row["Deg_table2"].items()) {
            const auto answer = by_degradation(scaled_model(tau), std::stod(level));
            const TradeoffFigures& f = answer.report_as<TradeoffReport>()->model;
            EXPECT_NEAR(*f.J_r_opt / row["Jr_o"].get<double>(), 1, 5e-4) << tau;
            EXPECT_NEAR(*f.J_d_opt / row["Jd_o"].get<double>(), 1, 5e-4) << tau;
            EXPECT_NEAR(*f.Ms / row["Ms_table2"][level].get<double>(), 1, 1e-3) << tau << " " << level;
            EXPECT_NEAR(*f.Deg, Deg.get<double>(), 1e-3) << tau << " " << level;
        }
        for (const auto& [Ms, I_perf] : row["Iperf_table1"].items()) {
            const auto answer = entry(scaled_model(tau), request("arrieta_ms", {{"Ms", std::stod(Ms)}}));
            EXPECT_NEAR(*answer.report_as<TradeoffReport>()->model.I_perf / I_perf.get<double>(), 1, 2e-3)
                << tau << " " << Ms;
        }
        const Fopdt model = scaled_model(tau);
        const TradeoffScale scale(*LinearPlant::make(model), reference_controllers(model));
        for (const auto& [Ms, I_perf] : row["Iperf_eq9_b3"].items()) {
            const IdealPid pid = arrieta_pid(arrieta_equation_9(std::stod(Ms), ArrietaC3::printed), model);
            EXPECT_NEAR(*scale.figures(to_parallel(pid)).I_perf / I_perf.get<double>(), 1, 2e-3) << tau << " " << Ms;
        }
    }
}

// Recomputes Deg: the optima and the free tuning's J_rd from the recomputed values, J_r and J_d from the general
// evaluation.
TEST(Arrieta, ExactHasTheDegradationAskedFor) {
    for (const auto& [tau, row] : reference()["tau_scan"].items()) {
        for (const double asked : {0.3, 0.4, 0.5}) {
            const auto answer = by_degradation(scaled_model(tau), asked, true);
            ASSERT_TRUE(answer.evaluation) << tau << " " << asked;
            EXPECT_NEAR(*answer.report_as<TradeoffReport>()->model.Deg, asked, 1e-7);
            const Performance& p = answer.evaluation->performance;
            const double J_rd =
                std::hypot(*p.setpoint.IAE - row["Jr_o"].get<double>(), *p.load.IAE - row["Jd_o"].get<double>());
            EXPECT_NEAR(1 - row["free"]["Jrd"].get<double>() / J_rd, asked, 1e-3) << tau << " " << asked;
            // Eq. 9 approximates Ms within a few per cent.
            EXPECT_NEAR(*answer.evaluation->robustness.Ms / *answer.report_as<TradeoffReport>()->Ms_design, 1, 0.03);
        }
    }
}

TEST(Arrieta, TheProfileIsWhatTheMethodsAnswerOneByOne) {
    auto method = request("arrieta_degradation", {{"degradation", 0.35}, {"profile", true}});
    const auto answer = entry(kProcess, method);
    ASSERT_TRUE(answer.report_as<TradeoffReport>()->profile);
    const TradeoffProfile& profile = *answer.report_as<TradeoffReport>()->profile;
    ASSERT_EQ(profile.by_Ms.size(), 13u);
    ASSERT_EQ(profile.by_degradation.size(), 5u);
    EXPECT_EQ(profile.by_Ms.front().level, 1.4);
    EXPECT_EQ(profile.by_Ms.back().level, 2);
    EXPECT_EQ(profile.by_degradation.front().Deg, 0);
    for (const ProfilePoint& point : profile.by_degradation) {
        const TradeoffFigures f = by_degradation(kProcess, point.level).report_as<TradeoffReport>()->model;
        EXPECT_DOUBLE_EQ(point.J_r, *f.J_r);
        EXPECT_DOUBLE_EQ(point.J_d, *f.J_d);
        EXPECT_DOUBLE_EQ(point.Ms, *f.Ms);
        EXPECT_DOUBLE_EQ(point.Deg, *f.Deg);
    }
    // Higher robustness means lower speed, all along Fig. 2.
    for (std::size_t i = 1; i < profile.by_Ms.size(); ++i) {
        EXPECT_GT(profile.by_Ms[i].Ms, profile.by_Ms[i - 1].Ms);
        EXPECT_GT(profile.by_Ms[i].I_perf, profile.by_Ms[i - 1].I_perf);
    }
    EXPECT_FALSE(by_degradation(kProcess, 0.35).report_as<TradeoffReport>()->profile);
}

}  // namespace
}  // namespace tunewright
