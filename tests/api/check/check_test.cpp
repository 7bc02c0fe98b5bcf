// POST /v1/check, jobs and batches of checks: answers against the document and each other.
#include <gmock/gmock.h>

#include <cmath>

#include "api/batch/plant_checks.h"
#include "api/services/check_service.h"
#include "engine/check/together/plant_check.h"
#include "engine/number_text.h"
#include "tests/api/support.h"
#include "tests/engine/check/simulated_loop.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

std::string csv_of(const check::LoopSetUp& loop, std::uint64_t seed) {
    const Record record = check::simulated(loop, seed);
    std::string out = "t,sp,pv,op\n";
    for (std::size_t i = 0; i < record.t.size(); ++i)
        out += tunewright::text(record.t[i], 9) + "," + tunewright::text(record.r[i], 9) + "," +
               tunewright::text(record.y[i], 9) + "," + tunewright::text(record.u[i], 9) + "\n";
    return out;
}

Json loop_of(const std::string& tag, const check::LoopSetUp& loop, std::uint64_t seed) {
    return {{"tag", tag}, {"kind", "flow"}, {"csv", csv_of(loop, seed)}, {"range", {{"op", {0, 100}}}}};
}

Json two_loops() {
    check::LoopSetUp sticking;
    sticking.band = 5;
    sticking.jump = 4;
    sticking.rows = 1500;
    check::LoopSetUp healthy;
    healthy.rows = 1500;
    return {{"loops", Json::array({loop_of("FIC1", sticking, 3), loop_of("FIC2", healthy, 4)})}};
}

Json checked(const Json& request) {
    const Answer answer = check_call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body.substr(0, 500);
    return Json::parse(answer.body);
}

TEST(Check, AnswersAsTheDocumentSays) {
    const Json answer = checked(two_loops());
    EXPECT_EQ(schema_faults(answer, "CheckCallAnswer"), std::vector<std::string>{});
    ASSERT_EQ(answer["loops"].size(), 2U);
    EXPECT_EQ(answer["loops"][0]["cause"]["verdict"], "stiction");
    EXPECT_EQ(answer["loops"][0]["action"]["code"], "repair-valve");
    EXPECT_EQ(answer["loops"][1]["cause"]["verdict"], "healthy");
    EXPECT_EQ(answer["ranking"][0]["loop"], 0);
    EXPECT_EQ(answer["partial"], false);
}

TEST(Check, TheSameRequestIsAJob) {
    const auto job = prepare_job(two_loops().dump());
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(job)) << std::get<Problem>(job).detail;
    const JobOutcome outcome = run_job(std::get<PreparedJob>(job), {});
    ASSERT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    EXPECT_EQ(outcome.method, "check");
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "CheckResult"), std::vector<std::string>{});
    EXPECT_EQ(result["loops"], checked(two_loops())["loops"]);
    const Json outline = Json::parse(outcome.outline_json);
    EXPECT_EQ(schema_faults(outline, "JobOutline"), std::vector<std::string>{});
    EXPECT_EQ(outline["check"]["tag"], "FIC1");
}

TEST(Check, ALoopThatCannotBeReadDoesNotStopTheOthers) {
    Json request = two_loops();
    request["loops"][0]["csv"] = "nothing, here";
    const Json answer = checked(request);
    EXPECT_EQ(answer["loops"][0]["tag"], "FIC1");
    EXPECT_EQ(answer["loops"][0]["cause"]["verdict"], "insufficient-data");
    EXPECT_EQ(answer["loops"][0]["quality"]["remarks"][0]["code"], "not-read");
    EXPECT_EQ(answer["loops"][1]["cause"]["verdict"], "healthy");
    EXPECT_EQ(schema_faults(answer, "CheckCallAnswer"), std::vector<std::string>{});
}

TEST(Check, BadRequestsNameTheMemberAndTheCure) {
    const auto refused = [](const Json& request) {
        const Answer answer = check_call(request.dump(), {});
        EXPECT_EQ(answer.status, 422) << answer.body.substr(0, 300);
        const Json errors = Json::parse(answer.body).value("errors", Json::array());
        return errors.empty() ? std::string()
                              : errors[0]["pointer"].get<std::string>() + " " + errors[0]["detail"].get<std::string>();
    };
    EXPECT_THAT(refused({{"loops", Json::array()}}), HasSubstr("/loops"));
    EXPECT_THAT(refused({{"loops", {{{"tag", "A"}}}}}), HasSubstr("/loops/0/record record is missing"));
    Json range = two_loops();
    range["loops"][1]["range"]["op"] = {100, 0};
    EXPECT_THAT(refused(range), HasSubstr("/loops/1/range/op"));
    Json start = two_loops();
    start["loops"][0]["start"] = "yesterday";
    EXPECT_THAT(refused(start), HasSubstr("/loops/0/start"));
    Json tune = two_loops();
    tune["tune"] = "all";
    EXPECT_THAT(refused(tune), HasSubstr("A check designs nothing"));
}

/// The judgement of a batch, one loop an entry, is that of one request with the same loops.
TEST(Check, ABatchIsJudgedAsOneRequest) {
    PlantChecks checks;
    const Json request = two_loops();
    for (std::size_t i = 0; i < 2; ++i) {
        const auto entry = prepare_entry(Json{{"loops", Json::array({request["loops"][i]})}}.dump());
        ASSERT_TRUE(std::holds_alternative<PreparedJob>(entry));
        const auto& job = std::get<PreparedJob>(entry);
        const JobOutcome outcome = run_job(StoredRequest{job.request_json, job.request_hash}, {});
        const std::string id = "job" + std::to_string(i);
        checks.add({static_cast<std::int64_t>(i), id, "", outcome.result_json, ""});
    }
    checks.add({2, "job2", "FIC3", "", R"({"detail": "No number."})"});
    const Json judged = Json::parse(checks.answer(true, nullptr)), whole = checked(request);
    EXPECT_EQ(schema_faults(judged, "BatchCheck"), std::vector<std::string>{});
    EXPECT_EQ(judged["failed"], 1);
    EXPECT_EQ(judged["ranking"], whole["ranking"]);
    EXPECT_EQ(judged["clusters"], whole["clusters"]);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(judged["loops"][i]["cause"]["verdict"], whole["loops"][i]["cause"]["verdict"]);
        EXPECT_EQ(judged["loops"][i]["job"], "job" + std::to_string(i));
        EXPECT_FALSE(judged["loops"][i].contains("shape"));
    }
    const Json compared = Json::parse(checks.answer(true, &checks));
    ASSERT_EQ(compared["changes"].size(), 2U);
    EXPECT_NEAR(compared["changes"][0]["change"]["variability_ratio"].get<double>(), 1, 1e-12);
    EXPECT_EQ(compared["changes"][0]["change"]["significant"], false);
    EXPECT_EQ(compared["changes"][0]["tag"], judged["loops"][0]["tag"]);
    EXPECT_FALSE(compared.contains("only_now") || compared.contains("only_before"));
}

PlantChecks with_loops(const std::vector<std::string>& tags) {
    PlantChecks checks;
    for (std::size_t i = 0; i < tags.size(); ++i) {
        const std::string result = Json{{"loops", Json::array({Json{{"tag", tags[i]}}})}}.dump();
        checks.add({static_cast<std::int64_t>(i), "job", tags[i], result, ""});
    }
    return checks;
}

/// Historians differ in the case of their tags; what has no counterpart is named.
TEST(Check, BatchesAreComparedByTag) {
    const PlantChecks before = with_loops({"FIC1", "LIC2", "TIC3"});
    PlantChecks now = with_loops({"fic1", "LIC2", "PIC4"});
    const Json compared = Json::parse(now.answer(true, &before));
    ASSERT_EQ(compared["changes"].size(), 2U);
    EXPECT_EQ(compared["changes"][0]["tag"], "fic1");
    EXPECT_EQ(compared["only_now"], Json::array({"PIC4"}));
    EXPECT_EQ(compared["only_before"], Json::array({"TIC3"}));
    EXPECT_EQ(compared["complete"], true);
    now.add({3, "job", "AIC5", "", ""});
    EXPECT_EQ(Json::parse(now.answer(true, nullptr))["complete"], false) << "one was cancelled";
}

/// Twice the variability is no chance; a hundredth more is.
TEST(Check, AChangeIsToldFromChance) {
    check::LoopCheck before, now;
    before.performance.variability = 1;
    before.performance.independent = now.performance.independent = 200;
    now.performance.variability = 2;
    EXPECT_TRUE(check::change_of(before, now).significant);
    now.performance.variability = 1.01;
    EXPECT_FALSE(check::change_of(before, now).significant);
    // F(199, 199) has its upper 0.5 % point at 1.442920 (scipy.stats.f).
    now.performance.variability = std::sqrt(1.442919525);
    EXPECT_NEAR(*check::change_of(before, now).likelihood, 0.01, 1e-7);
}

}  // namespace
}  // namespace tunewright::api
