// Answers end to end: the engine's results as JSON, checked against the document.
#include <gmock/gmock.h>

#include "api/contract/result/evaluation.h"
#include "api/examples/examples.h"
#include "engine/evaluation/best_so_far.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

Json run(const std::string& request) {
    const auto prepared = prepare_job(request);
    if (const auto* problem = std::get_if<Problem>(&prepared)) {
        ADD_FAILURE() << to_json(*problem);
        return {};
    }
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    if (outcome.result_json.empty()) return {};
    Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(result["request_hash"], std::get<PreparedJob>(prepared).request_hash);
    return result;
}

Json example(const std::string& id) {
    const Json document = Json::parse(examples_json());
    for (const Json& one : document["examples"]) {
        if (one["id"] == id) return one["request"];
    }
    ADD_FAILURE() << id;
    return {};
}

// Checks that any null figure in an object of figures has its reason in the same object.
void expect_every_null_explained(const Json& value, const std::string& at) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
            expect_every_null_explained(value[i], at + "/" + std::to_string(i));
    } else if (value.is_object()) {
        for (const auto& [name, member] : value.items()) {
            if (member.is_null() && name != "Ti") {
                EXPECT_TRUE(value.contains("why_null") && value["why_null"].contains(name)) << at << "/" << name;
            }
            expect_every_null_explained(member, at + "/" + name);
        }
    }
}

void expect_valid(const Json& answer, const char* component) {
    EXPECT_EQ(schema_faults(answer, component), std::vector<std::string>{});
    expect_every_null_explained(answer, "");
}

TEST(Answers, ANullFigureIsWrittenWithItsReason) {
    Robustness robustness;
    robustness.stable = true;
    robustness.Ms = 1.25;
    robustness.gain_margin = std::numeric_limits<double>::infinity();
    robustness.gain_margin.why = "No higher gain destabilises the loop.";
    robustness.tolerates.gain_high = no_figure(robustness.gain_margin.why);
    robustness.Ms.why = "Never shown: Ms is not null.";
    robustness.tolerates.gain_low = 0.5;
    const Json written = Json::parse(encode(robustness_contract(), robustness));
    EXPECT_EQ(written["Ms"], 1.25);
    EXPECT_TRUE(written["gain_margin"].is_null());
    EXPECT_EQ(written["why_null"]["gain_margin"], "No higher gain destabilises the loop.");
    EXPECT_FALSE(written["why_null"].contains("Ms"));
    EXPECT_EQ(written["tolerates"]["gain"], (Json::array({0.5, nullptr})));
    EXPECT_EQ(written["tolerates"]["why_null"]["gain"], "No higher gain destabilises the loop.");
    expect_valid(written, "Robustness");
}

TEST(Answers, TracesHaveSixDigitsAndFiguresAll) {
    Evaluation evaluation;
    Responses responses;
    responses.setpoint.y = {1.0 / 3};
    EXPECT_THAT(encode(responses_contract(), responses), HasSubstr("\"y\":[0.333333]"));
    Robustness robustness;
    robustness.Ms = 4.0 / 3;
    EXPECT_THAT(encode(robustness_contract(), robustness), HasSubstr("\"Ms\":1.3333333333333333"));
}

TEST(Answers, TheProgressIsOneObject) {
    const auto best = std::make_shared<BestSoFar>();
    best->controller = IdealPid{.Kp = 2};
    Progress progress{0.25, "tune", "Half of the starts are done.", best};
    const Json written = Json::parse(progress_json(progress));
    EXPECT_EQ(schema_faults(written, "Progress"), std::vector<std::string>{});
    EXPECT_EQ(written["best"]["controller"]["Kp"], 2);
    EXPECT_TRUE(Json::parse(progress_json({}))["best"].is_null());
}

TEST(Answers, EngineErrorsBecomeProblemsOfTheirKind) {
    const Problem invalid = to_problem({ErrorKind::invalid_argument, "plant/den/0", "den has a fault."});
    EXPECT_EQ(invalid.status, 422);
    EXPECT_EQ(invalid.errors.at(0).pointer, "/plant/den/0");
    EXPECT_EQ(to_problem({ErrorKind::not_identifiable, "", "x"}).type, "not-identifiable");
    EXPECT_EQ(to_problem({ErrorKind::no_feasible_controller, "", "x"}).type, "no-feasible-controller");
    EXPECT_EQ(to_problem({ErrorKind::unbounded_optimum, "", "x"}).type, "unbounded-optimum");
    EXPECT_EQ(to_problem({ErrorKind::timeout, "", "x"}).type, "timeout");
    EXPECT_EQ(to_problem({ErrorKind::cancelled, "", "x"}).status, 409);
    EXPECT_TRUE(to_problem({ErrorKind::timeout, "", "x"}).errors.empty());
}

TEST(Answers, EvaluateKeepsTheOrderOfTheControllersAndFitsTheDocument) {
    const Answer answer = evaluate_call(
        R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "controllers": [{"Kp": 0.9, "Ti": 10}, {"form": "parallel", "Ki": 0.02}, {"form": "series", "Kp": 0.8, "Ti": 10, "Td": 1, "filter": {"type": "derivative", "N": 10}}], "evaluate": {"points": 50, "noise": {"std": 0.1, "sample_time": 0.1}}})",
        {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    expect_valid(body, "EvaluateAnswer");
    ASSERT_EQ(body["controllers"].size(), 3u);
    EXPECT_EQ(body["controllers"][1]["controller"]["form"], "parallel");
    EXPECT_EQ(body["controllers"][2]["controller"]["form"], "series");
    const Json& first = body["controllers"][0];
    EXPECT_EQ(first["responses"]["load"]["t"].size(), 50u);
    EXPECT_EQ(first["responses"]["load"]["y"].size(), 50u);
    EXPECT_EQ(first["frequency"]["omega"].size(), first["frequency"]["L"]["re"].size());
    EXPECT_NEAR(first["equivalents"]["parallel"]["Ki"].get<double>(), 0.09, 1e-15);
    EXPECT_FALSE(first.contains("method"));
}

TEST(Answers, AnEvaluationSaysByWhichLimitItsControllersStandAndWhichToShow) {
    const std::string plant = R"("plant": {"type": "fopdt", "K": 1, "T": 10, "L": 3})";
    const std::string two =
        R"("controllers": [{"form": "ideal", "Kp": 30, "Ti": 4}, {"form": "ideal", "Kp": 1, "Ti": 9}])";
    const auto answered = [&](const std::string& more) {
        const Answer answer = evaluate_call("{" + plant + ", " + two + more + "}", {});
        EXPECT_EQ(answer.status, 200) << answer.body;
        const Json json = Json::parse(answer.body);
        EXPECT_EQ(schema_faults(json, "EvaluateAnswer"), std::vector<std::string>{});
        return json;
    };
    const Json usual = answered("");
    EXPECT_EQ(usual["rank_limits"], (Json{{"Ms", limits::kDefaultMaxRankedMs}}));
    EXPECT_EQ(usual["proposed"], 1);
    EXPECT_EQ(usual["verdict"][0]["figures"]["entry"], 1);
    EXPECT_EQ(usual["controllers"][1]["standing"]["group"], "holds");
    const Json tight = answered(R"(, "evaluate": {"rank_limits": {"Ms": 1.1}})");
    EXPECT_EQ(tight["rank_limits"], (Json{{"Ms", 1.1}}));
    EXPECT_EQ(tight["controllers"][1]["standing"]["group"], "above_limit");
}

TEST(Answers, AnUnstableLoopIsAnEntryWithReasonsForItsNulls) {
    const Answer answer = evaluate_call(
        R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "controllers": [{"Kp": 50, "Ti": 10}]})", {});
    ASSERT_EQ(answer.status, 200);
    const Json body = Json::parse(answer.body);
    expect_valid(body, "EvaluateAnswer");
    EXPECT_FALSE(body["controllers"][0]["robustness"]["stable"].get<bool>());
    EXPECT_TRUE(body["controllers"][0]["performance"]["load"]["IAE"].is_null());
    EXPECT_FALSE(body["controllers"][0]["warnings"].empty());
}

TEST(Answers, PointsZeroLeavesTheTracesOut) {
    const Answer answer = evaluate_call(
        R"({"plant": {"type": "ipdt", "K": 0.05, "L": 4}, "controllers": [{"Kp": 2, "Ti": 40}], "evaluate": {"points": 0}})",
        {});
    const Json body = Json::parse(answer.body);
    expect_valid(body, "EvaluateAnswer");
    EXPECT_FALSE(body["controllers"][0].contains("responses"));
    EXPECT_FALSE(body["controllers"][0].contains("frequency"));
}

TEST(Answers, AComparisonWithABaselineIsRankedAndFitsTheDocument) {
    const Json result = run(example("compare-methods").dump());
    expect_valid(result, "TuningResult");
    ASSERT_EQ(result["controllers"].size(), 6u);
    EXPECT_EQ(result["controllers"][5]["method"], "baseline");
    EXPECT_EQ(result["controllers"][0]["method"], "robust");
    EXPECT_EQ(result["controllers"][0]["options"]["Ms"], 1.4);
    EXPECT_EQ(result["ranking"].size(), 6u);
    EXPECT_EQ(result["units"]["y"], "degC");
    EXPECT_EQ(result["version"], TUNEWRIGHT_VERSION);
    EXPECT_FALSE(result["partial"].get<bool>());
    EXPECT_LE(result["controllers"][0]["robustness"]["Ms"].get<double>(), 1.4 * (1 + 2e-5));
}

TEST(Answers, ThePublishedExampleHasItsPublishedSettings) {
    const Json result = run(example("paper-third-order").dump());
    const Json& controller = result["controllers"][0]["controller"];
    EXPECT_NEAR(controller["Kp"].get<double>(), 6.534, 0.005 * 6.534);
    EXPECT_NEAR(controller["Ti"].get<double>(), 0.2207, 0.005 * 0.2207);
    EXPECT_NEAR(controller["Td"].get<double>(), 0.1644, 0.005 * 0.1644);
    EXPECT_EQ(controller["filter"]["Tf"], 1e-4);
}

TEST(Answers, EveryOtherExampleSucceedsAndFitsTheDocument) {
    for (const char* id :
         {"paper-oscillatory", "integrating-level", "inverse-response", "unstable-first-order", "two-tanks-state-space",
          "oscillatory-mass", "cstr-temperature", "cstr-concentration", "spherical-tank", "bioreactor", "ph-vessel"}) {
        SCOPED_TRACE(id);
        const Json result = run(example(id).dump());
        if (result.is_null()) continue;
        expect_valid(result, "TuningResult");
        for (const Json& entry : result["controllers"]) {
            EXPECT_FALSE(entry.contains("error")) << entry["error"].dump();
            EXPECT_TRUE(entry["robustness"]["stable"].get<bool>());
        }
    }
}

TEST(Answers, TheRecordedHeaterStepIsIdentifiedAndTuned) {
    const Json result = run(example("tclab-step").dump());
    expect_valid(result, "TuningResult");
    EXPECT_GE(result["model"]["fit_percent"].get<double>(), 97.2);
    EXPECT_EQ(result["model"]["data_quality"]["samples"].get<int>() +
                  result["model"]["data_quality"]["samples_dropped"].get<int>(),
              801);
    EXPECT_FALSE(result["model"]["candidates"].empty());
    EXPECT_LE(result["controllers"][0]["robustness"]["Ms"].get<double>(), 1.4 * (1 + 2e-5));
    EXPECT_LE(result["controllers"][0]["robustness"]["Mt"].get<double>(), 1.4 * (1 + 2e-5));
}

TEST(Answers, IdentifyCountsTheLinesThatTheCsvLacked) {
    std::string csv = "t;u;y\n";
    for (int i = 0; i <= 200; ++i) {
        const double t = 0.25 * i, y = t > 5 ? 2 * (1 - std::exp(-(t - 5) / 4)) : 0;
        csv += std::to_string(t) + ";" + (t >= 3 ? "1" : "0") + ";" + (i % 50 == 7 ? "" : std::to_string(y)) + "\n";
    }
    const Answer answer =
        identify_call(Json{{"record", {{"csv", csv}}}, {"identify", {{"model", "fopdt"}}}}.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    expect_valid(body, "IdentifyAnswer");
    EXPECT_EQ(body["model"]["data_quality"]["samples_dropped"], 4);
    EXPECT_NEAR(body["model"]["plant"]["K"].get<double>(), 2, 1e-3);
    EXPECT_NEAR(body["model"]["plant"]["T"].get<double>(), 4, 1e-2);
    EXPECT_NEAR(body["model"]["plant"]["L"].get<double>(), 2, 1e-2);
}

TEST(Answers, IdentifyUsesOnlyThePartOfTheRecordThatIsAskedFor) {
    // Outside the part the record is from another plant: its gain is 7, not 2.
    std::string csv = "t,u,y\n";
    for (int i = 0; i <= 400; ++i) {
        const double t = 0.25 * i, K = t <= 60 ? 2 : 7;
        csv += std::to_string(t) + "," + (t >= 3 ? "1" : "0") + "," +
               std::to_string(t > 5 ? K * (1 - std::exp(-(t - 5) / 4)) : 0) + "\n";
    }
    const Answer answer = identify_call(
        Json{{"record", {{"csv", csv}, {"from", 1}, {"to", 60}}}, {"identify", {{"model", "fopdt"}, {"traces", true}}}}
            .dump(),
        {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json model = Json::parse(answer.body)["model"];
    EXPECT_EQ(model["data_quality"]["samples"], 237);
    EXPECT_EQ(model["data_quality"]["test"], "one step of u");
    EXPECT_EQ(model["data_quality"]["move_times"], Json::array({3}));
    EXPECT_THAT(model["data_quality"]["notes"].dump(), HasSubstr("the 237 from 1 to 60 were used"));
    EXPECT_EQ(model["fit"]["t"].front(), 1);
    EXPECT_EQ(model["fit"]["t"].back(), 60);
    EXPECT_NEAR(model["plant"]["K"].get<double>(), 2, 1e-3);
    EXPECT_NEAR(model["plant"]["L"].get<double>(), 2, 1e-2);
}

// A record of 60 s whose times are seconds since 1970.
std::string epoch_record() {
    std::string csv = "timestamp,valve,temp\n";
    for (int i = 0; i < 120; ++i)
        csv += std::to_string(1747040000 + i) + "," + (i >= 10 ? "1" : "0") + "," +
               std::to_string(i > 12 ? 2 * (1 - std::exp(-(i - 12) / 9.0)) : 0) + "\n";
    return csv;
}

TEST(Answers, TracesOfAModelAreAnsweredWhereTheyAreAskedFor) {
    const Json record{{"csv", epoch_record()}};
    const Json without = Json::parse(identify_call(Json{{"record", record}}.dump(), {}).body);
    expect_valid(without, "IdentifyAnswer");
    EXPECT_FALSE(without["model"].contains("fit"));
    for (const Json& candidate : without["model"]["candidates"]) EXPECT_FALSE(candidate.contains("y_model"));

    const Json with =
        Json::parse(identify_call(Json{{"record", record}, {"identify", {{"traces", true}}}}.dump(), {}).body);
    expect_valid(with, "IdentifyAnswer");
    const Json& t = with["model"]["fit"]["t"];
    ASSERT_EQ(t.size(), 120u);
    EXPECT_EQ(t[0], 1747040000);
    EXPECT_EQ(t[1], 1747040001) << "times of many digits must still differ";
    for (const Json& candidate : with["model"]["candidates"]) EXPECT_EQ(candidate["y_model"].size(), t.size());
    EXPECT_EQ(with["model"]["plant"], without["model"]["plant"]);
}

TEST(Answers, AJobCarriesTheTracesOfItsModelWhereTheyAreAskedFor) {
    const Json tune = Json::array({{{"method", "simc"}}});
    const Json record{{"csv", epoch_record()}};
    const Json without = run(Json{{"record", record}, {"tune", tune}}.dump());
    expect_valid(without, "TuningResult");
    EXPECT_FALSE(without["model"].contains("fit"));
    const Json with = run(Json{{"record", record}, {"tune", tune}, {"identify", {{"traces", true}}}}.dump());
    EXPECT_EQ(with["model"]["fit"]["t"].size(), 120u);
}

TEST(Answers, AMethodThatFailsIsAnEntryAndAJobFailsOnlyIfAllDo) {
    // For a plant without lag and dead time, SIMC needs a given tau_c.
    const std::string plant = R"({"plant": {"type": "transfer_function", "num": [1], "den": [1, 1]}, "tune": [)";
    const Json result = run(plant + R"({"method": "ziegler_nichols_step"}, {"method": "simc", "tau_c": 0.5}]})");
    EXPECT_EQ(result["controllers"][0]["error"]["type"], "unsupported");
    EXPECT_TRUE(result["controllers"][1].contains("controller")) << result["controllers"][1].dump();
    EXPECT_EQ(result["ranking"], Json::array({1}));
    expect_valid(result, "TuningResult");

    const auto prepared = prepare_job(plant + R"({"method": "ziegler_nichols_step"}]})");
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::failed);
    EXPECT_EQ(schema_faults(Json::parse(outcome.error_json), "Problem"), std::vector<std::string>{});
}

TEST(Answers, AllAnswersWithEveryMethodBesideItsOptimumOrWithWhyNot) {
    const Json result = run(request_with(R"("tune": "all", "evaluate": {"points": 0})"));
    expect_valid(result, "TuningResult");
    for (const TuningMethod& method : method_registry()) {
        bool named = false;
        for (const Json& entry : result["controllers"]) named = named || entry["method"] == method.id;
        EXPECT_EQ(named, method.compared && !method.all_if_nonlinear) << method.id;
    }
    for (const Json& entry : result["controllers"]) {
        EXPECT_NE(entry.contains("error"), entry.contains("optimum_at_Ms")) << entry["title"];
        EXPECT_EQ(entry.contains("error"), !entry.contains("controller")) << entry["title"];
    }
}

TEST(Answers, AnEvaluationIsComparedWithTheOptimumAtItsMsWhereAsked) {
    const std::string body =
        R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "controllers": [{"form": "ideal", "Kp": 0.5, "Ti": 10}],
            "evaluate": {"points": 0, "optimum_at_Ms": true}})";
    const Json answer = Json::parse(evaluate_call(body, {}).body);
    expect_valid(answer, "EvaluateAnswer");
    const Json& entry = answer["controllers"][0];
    // No overshoot of u: IAE = Ti/Kp.
    EXPECT_NEAR(entry["performance"]["load"]["IAE"].get<double>(), 20, 1e-3);
    EXPECT_NEAR(entry["optimum_at_Ms"]["excess_percent"].get<double>(),
                100 * (20 / entry["optimum_at_Ms"]["IAE"].get<double>() - 1), 0.01);
    EXPECT_GT(entry["optimum_at_Ms"]["excess_percent"].get<double>(), 50);
}

TEST(Answers, ARevisedImcEntryCarriesItsFiguresItsCurveAndTheFullController) {
    const Json result = run(example("revised-imc").dump());
    expect_valid(result, "TuningResult");
    const Json& entry = result["controllers"][0];
    ASSERT_TRUE(entry.contains("rimc")) << entry.dump();
    const Json& rimc = entry["rimc"];
    EXPECT_NEAR(rimc["Ms"].get<double>(), 2, 2e-6);
    for (const char* figure : {"lambda", "disturbance_peak", "dead_time_error", "stability_limit"})
        EXPECT_GT(rimc[figure].get<double>(), 0) << figure;
    EXPECT_TRUE(rimc["full_controller"]["robustness"]["stable"].get<bool>());
    EXPECT_GT(rimc["full_controller"]["load"]["IAE"].get<double>(), 0);
    EXPECT_EQ(rimc["full_controller"]["responses"]["load"]["t"].size(), 400u);
    EXPECT_EQ(rimc["disturbance_peak_curve"]["lambda_over_tau"].size(), rimc["disturbance_peak_curve"]["Ms"].size());
    EXPECT_FALSE(result["controllers"][1].contains("rimc"));
}

TEST(Answers, ARevisedImcDesignThatIsUnstableOnItsModelSaysWhyItsFiguresAreNull) {
    const Json result = run(
        R"({"plant": {"type": "fopdt", "K": 0.98, "T": 21.8291, "L": 2.7993}, "tune": [{"method": "rimc", "lambda": 0.9}], "evaluate": {"points": 0}})");
    expect_valid(result, "TuningResult");
    const Json& rimc = result["controllers"][0]["rimc"];
    for (const char* figure : {"Ms", "disturbance_peak", "dead_time_error"}) {
        EXPECT_TRUE(rimc[figure].is_null()) << figure;
        EXPECT_TRUE(rimc["why_null"].contains(figure)) << figure;
    }
    EXPECT_EQ(result["controllers"][0]["warnings"][0]["code"], "unstable-model-loop");
    EXPECT_TRUE(rimc["full_controller"]["robustness"]["stable"].get<bool>());
}

TEST(Answers, ASurfaceIsWrittenAsAMatrix) {
    const Json result = run(request_with(
        R"("tune": [{"method": "robust", "search": "grid", "surface": true}], "evaluate": {"points": 0})"));
    expect_valid(result, "TuningResult");
    const Json& surface = result["controllers"][0]["surface"];
    ASSERT_TRUE(surface.is_object());
    EXPECT_EQ(surface["cost"].size(), surface["Ti"].size());
    EXPECT_EQ(surface["cost"][0].size(), surface["Td"].size());
}

TEST(Answers, AStoppedJobIsCancelled) {
    const auto prepared = prepare_job(example("compare-methods").dump());
    std::stop_source source;
    source.request_stop();
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), {source.get_token(), {}, {}});
    EXPECT_EQ(outcome.status, JobOutcome::Status::cancelled);
    EXPECT_TRUE(outcome.error_json.empty());
}

}  // namespace
}  // namespace tunewright::api
