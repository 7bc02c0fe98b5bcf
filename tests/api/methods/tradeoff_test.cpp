// The servo/regulation methods and the trade-off in the contract: options that are a number or a word, the fields of
// entries, null values.
#include <gmock/gmock.h>

#include "api/examples/examples.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

constexpr const char* kFigures[] = {"J_r", "J_d", "J_rd", "J_r_opt", "J_d_opt", "I_perf", "Deg", "Ms"};

std::vector<FieldError> tradeoff_faults(const std::string& tune) {
    const auto prepared = prepare_job(request_with(R"("tune": [)" + tune + "]"));
    const auto* problem = std::get_if<Problem>(&prepared);
    return problem ? problem->errors : std::vector<FieldError>{};
}

Json tuned(const std::string& request) {
    const JobOutcome outcome = run_job(StoredRequest{request, {}}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "TuningResult"), std::vector<std::string>{});
    return result;
}

Json evaluated(const std::string& request) {
    const Answer answer = evaluate_call(request, {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(body, "EvaluateAnswer"), std::vector<std::string>{});
    return body;
}

TEST(NumberOrWord, BothAreTakenAndFitTheDocument) {
    for (const char* Ms : {R"("free")", "1.4", "1.55", "2"}) {
        const std::string method = std::string(R"({"method": "arrieta_ms", "Ms": )") + Ms + "}";
        EXPECT_TRUE(tradeoff_faults(method).empty()) << Ms;
        EXPECT_EQ(schema_faults(Json::parse(method), "Method"), std::vector<std::string>{});
        const Json result = tuned(request_with(R"("tune": [)" + method + R"(], "evaluate": {"points": 0})"));
        EXPECT_EQ(result["controllers"][0]["options"]["Ms"], Json::parse(Ms));
    }
}

TEST(NumberOrWord, OtherValuesAreRefusedInWordsAndByTheDocument) {
    struct Case {
        const char* Ms;
        const char* words;
    };
    for (const auto& [Ms, words] : {Case{R"("fre")", "Did you mean free?"},
                                    {"1.3", "Ms is 1.3; it must be >= 1.4 and <= 2. The word free"},
                                    {"2.01", "it must be >= 1.4 and <= 2"},
                                    {"true", "it must be a number or the word free"},
                                    {"null", "it must be a number or the word free"},
                                    {R"("1.6")", "Write 1.6 without quotes"}}) {
        const std::string method = std::string(R"({"method": "arrieta_ms", "Ms": )") + Ms + "}";
        EXPECT_THAT(detail_at(tradeoff_faults(method), "/tune/0/Ms"), HasSubstr(words)) << Ms;
        EXPECT_FALSE(schema_faults(Json::parse(method), "Method").empty()) << Ms;
    }
}

TEST(NumberOrWord, TheOptionsOfADegradationAreChecked) {
    EXPECT_THAT(
        detail_at(tradeoff_faults(R"({"method": "arrieta_degradation", "degradation": -0.1})"), "/tune/0/degradation"),
        HasSubstr("it must be >= 0"));
    EXPECT_THAT(detail_at(tradeoff_faults(R"({"method": "arrieta_degradation", "exact": "yes"})"), "/tune/0/exact"),
                HasSubstr("true or false"));
    EXPECT_THAT(
        detail_at(tradeoff_faults(R"({"method": "arrieta_degradation", "degredation": 0.3})"), "/tune/0/degredation"),
        HasSubstr("did you mean degradation?"));
}

TEST(NumberOrWord, OfAllTheWordAndAnyMethodsNumberAreTaken) {
    EXPECT_TRUE(tradeoff_faults(R"({"method": "all", "Ms": "free"})").empty());
    EXPECT_TRUE(tradeoff_faults(R"({"method": "all", "Ms": 1.2})").empty());
    EXPECT_FALSE(tradeoff_faults(R"({"method": "all", "Ms": "fast"})").empty());
}

TEST(TradeoffAnswer, TheExampleHasItWithItsCurves) {
    const Json examples = Json::parse(examples_json())["examples"];
    const auto at = std::find_if(examples.begin(), examples.end(),
                                 [](const Json& example) { return example["id"] == "allowed-degradation"; });
    ASSERT_NE(at, examples.end());
    const Json result = tuned((*at)["request"].dump());
    ASSERT_EQ(result["controllers"].size(), 6u);
    for (const Json& entry : result["controllers"]) {
        const Json& tradeoff = entry["tradeoff"];
        EXPECT_EQ(tradeoff["fopdt"]["type"], "fopdt");
        EXPECT_NE(tradeoff["constants"].get<std::string>(), "");
        for (const char* place : {"model", "plant"})
            for (const char* figure : kFigures) EXPECT_TRUE(tradeoff[place][figure].is_number()) << place << figure;
    }
    EXPECT_NEAR(result["controllers"][0]["tradeoff"]["plant"]["J_r"].get<double>(), 1.4229, 5e-4);
    EXPECT_FALSE(result["controllers"][0]["tradeoff"].contains("profile"));
    const Json& exact = result["controllers"][4]["tradeoff"];
    EXPECT_NEAR(exact["model"]["Deg"].get<double>(), 0.4, 1e-6);
    EXPECT_THAT(exact["constants"].get<std::string>(), HasSubstr("Eq. 9"));
    ASSERT_EQ(exact["profile"]["by_Ms"].size(), 13u);
    ASSERT_EQ(exact["profile"]["by_degradation"].size(), 5u);
    for (const char* name : {"Ms_design", "Ms", "J_r", "J_d", "J_rd", "I_perf", "Deg"})
        EXPECT_TRUE(exact["profile"]["by_Ms"][3][name].is_number()) << name;
    EXPECT_EQ(exact["profile"]["by_degradation"][2]["degradation"], 0.35);
}

TEST(TradeoffAnswer, OfAnyControllerOnlyWhereAskedForAndOfTheBaselineToo) {
    const std::string members =
        R"("tune": [{"method": "simc"}], "baseline": {"form": "series", "Kp": 1, "Ti": 10, "Td": 1}, "evaluate": {"points": 0)";
    const Json asked = tuned(request_with(members + R"(, "tradeoff": true})"));
    for (const Json& entry : asked["controllers"]) EXPECT_TRUE(entry["tradeoff"]["model"]["J_rd"].is_number());
    EXPECT_FALSE(asked["controllers"][0]["tradeoff"].contains("constants"));
    const Json not_asked = tuned(request_with(members + "}"));
    for (const Json& entry : not_asked["controllers"]) EXPECT_FALSE(entry.contains("tradeoff"));
}

TEST(TradeoffAnswer, EvaluateTellsItAboutThePlantsReduction) {
    const std::string body =
        R"({"plant": {"type": "sopdt", "K": 2, "T1": 10, "T2": 5, "L": 3}, "controllers": [{"Kp": 0.5, "Ti": 10}, {"Kp": 0.5}], "evaluate": {"points": 0, "tradeoff": )";
    const Json answer = evaluated(body + "true}}");
    const Json& first = answer["controllers"][0]["tradeoff"];
    EXPECT_EQ(first["fopdt"]["type"], "fopdt");
    for (const char* figure : kFigures) EXPECT_TRUE(first["plant"][figure].is_number()) << figure;
    const Json& second = answer["controllers"][1]["tradeoff"]["plant"];
    EXPECT_TRUE(second["J_r"].is_null());
    EXPECT_THAT(second["why_null"]["J_r"].get<std::string>(), HasSubstr("Without integral action"));
    EXPECT_FALSE(evaluated(body + "false}}")["controllers"][0].contains("tradeoff"));
}

TEST(TradeoffAnswer, WhereItCannotBeEveryFigureIsNullWithItsReason) {
    for (
        const char* plant :
        {R"({"type": "ipdt", "K": 1, "L": 1})", R"({"type": "fopdt", "K": 1, "T": 1, "L": 1})",
         R"({"type": "frequency_response", "omega": [0.01, 0.1, 0.5, 1, 2, 5, 10, 50], "re": [1, 0.99, 0.8, 0.5, 0.2, 0.04, 0.01, 0.0004], "im": [-0.01, -0.1, -0.4, -0.5, -0.4, -0.19, -0.1, -0.02]})"}) {
        const Answer answer =
            evaluate_call(std::string(R"({"plant": )") + plant +
                              R"(, "controllers": [{"Kp": 10, "Ti": 1}], "evaluate": {"points": 0, "tradeoff": true}})",
                          {});
        ASSERT_EQ(answer.status, 200) << answer.body;
        const Json body = Json::parse(answer.body);
        EXPECT_EQ(schema_faults(body, "EvaluateAnswer"), std::vector<std::string>{});
        for (const char* place : {"model", "plant"})
            for (const char* figure : kFigures) {
                const Json& figures = body["controllers"][0]["tradeoff"][place];
                EXPECT_TRUE(figures[figure].is_null()) << plant << place << figure;
                EXPECT_TRUE(figures["why_null"].contains(figure)) << plant << place << figure;
            }
    }
}

}  // namespace
}  // namespace tunewright::api
