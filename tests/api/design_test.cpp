// POST /v1/design and /v1/frontier: what they answer, as what, and what they refuse.
#include <gmock/gmock.h>

#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

constexpr const char* kLagPlant = R"("plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3})";

void expect_kept(const Json& value, const std::string& component) {
    EXPECT_EQ(schema_faults(value, component), std::vector<std::string>{});
}

Json design_run(const std::string& request) {
    const auto outcome = run_job(std::get<PreparedJob>(prepare_job(request)), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    return Json::parse(outcome.result_json);
}

Answer design(const std::string& members) {
    return design_call("{" + std::string(kLagPlant) + ", " + members + "}", {});
}

TEST(Design, AnswersWhatAJobAnswers) {
    const std::string members =
        R"("tune": [{"method": "robust", "Ms": 1.6, "Mt": 1.5}], "baseline": {"Kp": 0.5, "Ti": 10})";
    const Answer answer = design(members);
    ASSERT_EQ(answer.status, 200) << answer.body;
    Json live = Json::parse(answer.body);
    expect_kept(live, "DesignAnswer");
    Json job = design_run("{" + std::string(kLagPlant) + ", " + members + "}");
    ASSERT_EQ(live["controllers"].size(), 2u);
    for (Json* of : {&live, &job})
        for (Json& entry : (*of)["controllers"]) entry.erase("compute_ms");
    EXPECT_EQ(live["controllers"], job["controllers"]);
}

TEST(Design, DoesNotDependOnWhereItStarts) {
    const std::string tune = R"("tune": [{"method": "robust"}], "evaluate": {"points": 0})";
    const Json alone = Json::parse(design(tune).body)["controllers"][0]["controller"];
    for (const char* start :
         {R"({"Kp": 1000, "Ti": 0.001})", R"({"Kp": -1, "Ti": 10})",
          R"({"Kp": 0.5, "Ti": 9, "Td": 1, "filter": {"type": "measurement_second_order", "Tf": 0.1}})"}) {
        const Answer answer = design(tune + R"(, "start": )" + start);
        ASSERT_EQ(answer.status, 200) << answer.body;
        EXPECT_EQ(Json::parse(answer.body)["controllers"][0]["controller"], alone) << start;
    }
}

TEST(Design, IsOfOneMethodOnAPlant) {
    const Answer two = design(R"("tune": [{"method": "robust"}, {"method": "simc"}])");
    EXPECT_EQ(two.status, 422);
    EXPECT_THAT(two.body, HasSubstr("\"/tune\""));
    const Answer all = design(R"("tune": [{"method": "all"}])");
    EXPECT_EQ(all.status, 422);
    EXPECT_THAT(all.body, HasSubstr("one"));
    const Answer record = design_call(R"({"record": {"dt": 1, "u": [0, 1], "y": [0, 1]}})", {});
    EXPECT_EQ(record.status, 422);
    EXPECT_THAT(record.body, HasSubstr("record is not a field here"));
    const Answer start = design(R"("start": {"Kp": "x"})");
    EXPECT_EQ(start.status, 422);
    EXPECT_THAT(start.body, HasSubstr("/start/Kp"));
}

TEST(Design, SaysWhyThereIsNone) {
    const Answer answer = design_call(
        R"({"plant": {"type": "fopdt", "K": 1, "T": -1, "L": 0.5}, "tune": [{"method": "robust", "Ms": 1.2, "Mt": 1.2}]})",
        {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_THAT(answer.body, HasSubstr("no-feasible-controller"));
    const Json cure = Json::parse(answer.body).at("cure");
    EXPECT_GT(cure.at("options").at("Ms"), 1.2);
    EXPECT_EQ(cure.at("options").at("Ms"), cure.at("options").at("Mt"));
    EXPECT_THAT(answer.body, HasSubstr("works is Ms = Mt = " + cure.at("options").at("Ms").dump()));
}

TEST(FrontierCall, AnswersPointsInOrder) {
    const Answer answer = frontier_call(
        "{" + std::string(kLagPlant) + R"(, "controller": "PI", "Ms": {"from": 1.2, "to": 2, "points": 5}, "Mt": 1.4})",
        {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json front = Json::parse(answer.body);
    expect_kept(front, "Frontier");
    ASSERT_EQ(front["points"].size(), 5u);
    double last = 1e9;
    for (const Json& point : front["points"]) {
        EXPECT_LT(point["load_IAE"].get<double>(), last);
        last = point["load_IAE"];
        EXPECT_LE(point["achieved"]["Ms"].get<double>(), point["Ms"].get<double>() * (1 + 2e-5));
        EXPECT_LE(point["achieved"]["Mt"].get<double>(), 1.4 * (1 + 2e-5));
        EXPECT_FALSE(point["controller"].contains("Td") && point["controller"]["Td"] > 0);
    }
    EXPECT_TRUE(front["infeasible_below"].is_null());
}

TEST(FrontierCall, IsAMethodOfJobsToo) {
    const Json result =
        design_run("{" + std::string(kLagPlant) +
                   R"(, "tune": [{"method": "frontier", "Ms": {"points": 4}}], "evaluate": {"points": 0}})");
    expect_kept(result, "TuningResult");
    EXPECT_EQ(result["controllers"][0]["frontier"]["points"].size(), 4u);
}

TEST(FrontierCall, RefusesWithPlaceAndCure) {
    const Answer range = frontier_call("{" + std::string(kLagPlant) + R"(, "Ms": {"from": 0.5}})", {});
    EXPECT_EQ(range.status, 422);
    EXPECT_THAT(range.body, HasSubstr("/Ms/from"));
    const Answer word = frontier_call("{" + std::string(kLagPlant) + R"(, "Mt": "loose"})", {});
    EXPECT_EQ(word.status, 422);
    EXPECT_THAT(word.body, HasSubstr("tied"));
    const Answer backwards = frontier_call("{" + std::string(kLagPlant) + R"(, "Ms": {"from": 2, "to": 1.5}})", {});
    EXPECT_EQ(backwards.status, 422);
    EXPECT_THAT(backwards.body, HasSubstr("to must be > from"));
}

}  // namespace
}  // namespace tunewright::api
