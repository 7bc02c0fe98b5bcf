// Sets, ranges and measured points through JSON: read, refused, answered.
#include <gmock/gmock.h>

#include "api/contract/plant/plant.h"
#include "api/contract/request.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

constexpr const char* kPoints =
    R"("omega": [0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.7, 1, 1.5],
       "re": [1.89655, 1.46248, 0.659816, -0.12158, -0.345674, -0.392635, -0.261892, -0.0475484, 0.127895],
       "im": [-0.499239, -1.03012, -1.25086, -0.886125, -0.529631, -0.184589, 0.106829, 0.193244, 0.0366325])";

Json run(const std::string& request) {
    const auto prepared = prepare_job(request);
    if (const auto* problem = std::get_if<Problem>(&prepared)) {
        ADD_FAILURE() << to_json(*problem);
        return {};
    }
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json result = outcome.result_json.empty() ? Json() : Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "TuningResult"), std::vector<std::string>{});
    return result;
}

std::vector<FieldError> uncertain_faults(const std::string& plant) {
    return decode<PlantModel>(plant_model_contract(), plant).faults;
}

TEST(UncertainPlants, AreReadAndWrittenAsSent) {
    for (
        const std::string plant :
        {R"({"type":"fopdt","K":2,"T":10,"L":3,"uncertainty":{"K":[0.8,1.2],"L":[0.9,1.25]}})",
         R"({"type":"set","plants":[{"type":"fopdt","K":2,"T":10,"L":3},{"type":"ipdt","K":1,"L":1,"T":0}]})",
         R"({"type":"frequency_response","omega":[1,2,3,4,5,6,7,8],"re":[8,7,6,5,4,3,2,1],"im":[-1,-2,-3,-3,-3,-3,-2,-1],"unstable_poles":0,"integrators":0})"}) {
        const auto read = decode<PlantModel>(plant_model_contract(), plant);
        EXPECT_TRUE(read.faults.empty()) << read.faults.front().detail;
        EXPECT_EQ(Json::parse(encode(plant_model_contract(), read.value)), Json::parse(plant));
        EXPECT_EQ(schema_faults(Json::parse(plant), "PlantModel"), std::vector<std::string>{});
    }
}

TEST(UncertainPlants, RangesAreAnsweredWithTheirRegion) {
    const Json result = run(
        R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3, "uncertainty": {"K": [0.8, 1.2], "L": [0.9, 1.2]}},
            "tune": [{"method": "robust"}, {"method": "simc"}], "evaluate": {"points": 0}})");
    const Json &robust = result["controllers"][0]["region"], &simc = result["controllers"][1]["region"];
    EXPECT_EQ(robust["stable_fraction"], 1);
    EXPECT_NEAR(robust["worst_Ms"].get<double>(), 1.4, 1e-3);
    EXPECT_GT(simc["worst_Ms"].get<double>(), 2);
    // Both are worst where gain and dead time are largest.
    EXPECT_EQ(simc["worst_plant"], (Json{{"type", "fopdt"}, {"K", 2.4}, {"T", 10}, {"L", 3.6}}));
}

TEST(UncertainPlants, SlidersGetTheRegionToo) {
    const Answer answer = evaluate_call(
        R"({"plant": {"type": "set", "plants": [{"type": "fopdt", "K": 1, "T": 10, "L": 1}, {"type": "fopdt", "K": 4, "T": 10, "L": 3}]},
            "controllers": [{"Kp": 5, "Ti": 8}], "evaluate": {"points": 0}})",
        {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(body, "EvaluateAnswer"), std::vector<std::string>{});
    const Json& region = body["controllers"][0]["region"];
    EXPECT_EQ(region["stable_fraction"], 0.5);
    EXPECT_TRUE(region["worst_Ms"].is_null());
    EXPECT_THAT(region["why_null"]["worst_Ms"].get<std::string>(), HasSubstr("unstable on at least one plant"));
}

TEST(UncertainPlants, MeasuredPointsAreTunedWithoutFiguresOverTime) {
    const Json result = run(R"({"plant": {"type": "frequency_response", )" + std::string(kPoints) + R"(},
                                "tune": [{"method": "robust"}, {"method": "amigo"}], "evaluate": {"points": 50}})");
    const Json& entry = result["controllers"][0];
    EXPECT_TRUE(entry["robustness"]["stable"].get<bool>());
    EXPECT_LE(entry["robustness"]["Ms"].get<double>(), 1.4 * (1 + 2e-5));
    EXPECT_TRUE(entry["performance"]["load"]["IAE"].is_null());
    EXPECT_THAT(entry["performance"]["load"]["why_null"]["IAE"].get<std::string>(), HasSubstr("points"));
    EXPECT_FALSE(entry.contains("responses"));
    EXPECT_GT(entry["frequency"]["omega"].size(), 20u);
    EXPECT_EQ(result["controllers"][1]["error"]["type"], "unsupported");
}

TEST(UncertainPlants, FaultyPointsAreRefusedAtTheirPlace) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string plant = R"({"type": "frequency_response", )" + std::string(kPoints) + "}";
        return plant.replace(plant.find(from), from.size(), to);
    };
    EXPECT_THAT(detail_at(uncertain_faults(with("0.1, 0.2", "0.2, 0.1")), "/omega/3"), HasSubstr("ascending order"));
    EXPECT_THAT(detail_at(uncertain_faults(with("1.46248, ", "")), "/re"), HasSubstr("numbers must be equal"));
    EXPECT_THAT(detail_at(uncertain_faults(with("0.02, ", "0, ")), "/omega/0"), HasSubstr("> 0"));
    EXPECT_THAT(detail_at(uncertain_faults(with("0.0366325]", "0.0366325], \"integrators\": -1")), "/integrators"),
                HasSubstr("integrators"));
    EXPECT_THAT(
        detail_at(uncertain_faults(R"({"type": "frequency_response", "omega": [1, 2], "re": [1, 1], "im": [0, 0]})"),
                  "/omega"),
        HasSubstr("8"));
}

}  // namespace
}  // namespace tunewright::api
