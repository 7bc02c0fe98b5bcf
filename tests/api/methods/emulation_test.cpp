// The method emulation in the contract: its options in requests and echoes, the contents of its entry, and the
// document.
#include <gmock/gmock.h>

#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

const Json kTank = Json::parse(R"json({"type": "nonlinear", "states": {"h": 1}, "parameters": {"c": 0.5, "k": 0.4},
    "equations": {"h": "(q - c*sqrt(h))/(3.14159265*k^2*h^2)"}, "input": {"name": "q", "nominal": 0.5},
    "output": "h"})json");

const Json kMethod = Json::parse(R"({"method": "emulation", "controller": "PI", "target": {"gamma": 1.5},
    "scenarios": [{"setpoint_step": 0.3}, {"setpoint_step": 0, "initial": {"h": 0.8}},
                  {"setpoint_step": 0.2, "parameters": {"c": 0.55}}],
    "horizon": 8, "weights": {"wy": 4}, "bounds": {"Kp": [0.05, 5]},
    "bounds_from": {"methods": ["imc"], "alpha": [0.3, 4]}})");

Json request(const Json& tune, const Json& plant, int points = 0) {
    return {{"plant", plant}, {"tune", tune}, {"evaluate", {{"points", points}}}};
}

Json emulated(const Json& request) {
    const JobOutcome outcome = run_job(StoredRequest{request.dump(), {}}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "TuningResult"), std::vector<std::string>{});
    return result;
}

std::vector<FieldError> faults_of(const Json& changes) {
    Json method = kMethod;
    method.update(changes);
    const auto prepared = prepare_job(request(Json::array({method}), kTank).dump());
    const auto* problem = std::get_if<Problem>(&prepared);
    return problem ? problem->errors : std::vector<FieldError>{};
}

TEST(EmulationContract, AnEntryCarriesBothLevelsAndFitsTheDocument) {
    const Json entry = emulated(request(Json::array({kMethod}), kTank, 100))["controllers"][0];
    ASSERT_TRUE(entry.contains("emulation")) << entry.dump();
    const Json& emulation = entry["emulation"];
    EXPECT_EQ(emulation["formulation"], "full");
    EXPECT_EQ(emulation["weights"], (Json{{"wy", 4.0}, {"wu", 1.0}}));
    EXPECT_NEAR(emulation["J"].get<double>(), 4 * emulation["J_y"].get<double>() + emulation["J_u"].get<double>(),
                1e-9);
    EXPECT_EQ(emulation["bounds"]["Kp"], (Json{0.05, 5.0}));
    EXPECT_EQ(emulation["target"]["beta"], (Json{1.0, 1.5}));
    EXPECT_EQ(emulation["relative_degree"], 1);
    EXPECT_EQ(emulation["fit"]["adequate"].get<bool>(),
              emulation["fit"]["u_left"] <= 0.1 && emulation["fit"]["y_left"] <= 0.05);
    ASSERT_EQ(emulation["level1"].size(), 2u);
    EXPECT_EQ(emulation["level1"][0]["test"], "step");
    EXPECT_EQ(emulation["level1"][1]["test"], "linear");
    ASSERT_EQ(emulation["scenarios"].size(), 3u);
    EXPECT_EQ(emulation["t"].size(), emulation["y_nl"].size());
    EXPECT_NEAR(emulation["y_nl"].front().get<double>(), 1, 1e-6);
    EXPECT_EQ(emulation["scenarios"][1]["initial"], (Json{{"h", 0.8}}));
    const auto unordered = [](const Json& value) { return nlohmann::json::parse(value.dump()); };
    EXPECT_EQ(unordered(entry["options"]["scenarios"]), unordered(kMethod["scenarios"]));
    EXPECT_EQ(unordered(entry["options"]["bounds_from"]), unordered(kMethod["bounds_from"]));
    EXPECT_EQ(entry["options"]["formulation"], "full");
}

TEST(EmulationContract, WithoutPointsOnlyWhatIsEmulatedHasTraces) {
    const Json emulation = emulated(request(Json::array({kMethod}), kTank))["controllers"][0]["emulation"];
    EXPECT_EQ(emulation["t"].size(), 401u);
    EXPECT_EQ(emulation["y_nl"].size(), 401u);
    EXPECT_EQ(emulation["u_nl"].size(), 401u);
    EXPECT_FALSE(emulation["scenarios"][0].contains("y"));
    EXPECT_FALSE(emulation["scenarios"][1].contains("y_nl"));
    EXPECT_FALSE(emulation["level1"][0].contains("u"));
    EXPECT_GT(emulation["J"].get<double>(), 0);
}

TEST(EmulationContract, RemarkSixHasNoOutputPartAndSaysSo) {
    Json method = kMethod;
    method["formulation"] = "remark6";
    const Json emulation = emulated(request(Json::array({method}), kTank))["controllers"][0]["emulation"];
    EXPECT_TRUE(emulation["J_y"].is_null());
    EXPECT_THAT(emulation["why_null"]["J_y"].get<std::string>(), HasSubstr("Remark 6"));
}

TEST(EmulationContract, OptionsAreRefusedAtTheirPlace) {
    EXPECT_THAT(detail_at(faults_of({{"bounds", {{"Kp", {5, 0.05}}}}}), "/tune/0/bounds/Kp"),
                HasSubstr("the first number must be below the second"));
    EXPECT_THAT(detail_at(faults_of({{"scenarios", {{{"initial", {{"h", 1}}}}}}}), "/tune/0/scenarios/0/setpoint_step"),
                HasSubstr("missing"));
    EXPECT_THAT(detail_at(faults_of({{"scenarios", Json::array()}}), "/tune/0/scenarios"), HasSubstr("1 to 20"));
    EXPECT_THAT(detail_at(faults_of({{"Tf", {0, 1}}}), "/tune/0/Tf/0"), HasSubstr("> 0"));
    EXPECT_THAT(detail_at(faults_of({{"target", {{"gama", 1}}}}), "/tune/0/target/gama"),
                HasSubstr("did you mean gamma?"));
    EXPECT_THAT(detail_at(faults_of({{"weights", {{"wy", -1}}}}), "/tune/0/weights/wy"), HasSubstr(">= 0"));
}

TEST(EmulationContract, AllRunsItOnNonlinearPlantsOnly) {
    const auto methods_of = [](const Json& plant) {
        std::vector<std::string> methods;
        const Json result =
            emulated({{"plant", plant}, {"tune", "all"}, {"evaluate", {{"points", 0}, {"optimum_at_Ms", false}}}});
        for (const Json& entry : result["controllers"]) methods.push_back(entry["method"]);
        return methods;
    };
    EXPECT_THAT(methods_of(kTank), testing::Contains("emulation"));
    EXPECT_THAT(methods_of({{"type", "fopdt"}, {"K", 1}, {"T", 2}, {"L", 0.5}}),
                testing::Not(testing::Contains("emulation")));
}

TEST(EmulationContract, ByNameItRunsOnLinearPlantsToo) {
    const Json entry = emulated(request(Json::array({Json{{"method", "emulation"}, {"controller", "PI"}}}),
                                        {{"type", "fopdt"}, {"K", 1}, {"T", 2}, {"L", 0.5}}))["controllers"][0];
    EXPECT_TRUE(entry.contains("emulation")) << entry.dump();
}

}  // namespace
}  // namespace tunewright::api
