// POST /v1/score and the file of a certificate.
#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <variant>

#include "api/certificate/certificate_call.h"
#include "api/certificate/problem_library.h"
#include "api/service.h"
#include "api/services/score_service.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Json scored(const Json& request) {
    const Answer answer = score_call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    const Json out = Json::parse(answer.body);
    EXPECT_THAT(schema_faults(out, "ScoreAnswer"), IsEmpty());
    return out;
}

Json rule(const Json& options) { return {{"tune", options}, {"problems", {{"name", "amigo/lag-delay/"}}}}; }

TEST(ScoreCall, FormulasOfSimcHaveTheScoreOfSimc) {
    const Json own = scored(rule({{"method", "formula"}, {"Kp", "T/(2*K*L)"}, {"Ti", "min(T, 8*L)"}}));
    Json built_in = rule({{"method", "simc"}, {"controller", "PI"}});
    const Json theirs = scored(built_in);
    ASSERT_EQ(own["problems"].size(), theirs["problems"].size());
    EXPECT_GT(own["kept"], 0);
    EXPECT_GT(own["limits_broken"], 0);
    for (std::size_t i = 0; i < own["problems"].size(); ++i) {
        const Json &a = own["problems"][i], &b = theirs["problems"][i];
        EXPECT_EQ(a["status"], b["status"]);
        EXPECT_NEAR(a["ratio"].get<double>(), b["ratio"].get<double>(), 1e-9 * b["ratio"].get<double>());
    }
    EXPECT_EQ(own["profile"].back()["share"], own["kept"].get<double>() / double(own["problems"].size()));
}

TEST(ScoreCall, TheBestKnownControllersHaveTheirOwnGapAsRatio) {
    const Json found = scored(rule({{"method", "robust"}}));
    EXPECT_EQ(found["kept"], found["problems"].size());
    for (const Json& one : found["problems"]) {
        const auto& library = problem_library();
        const auto problem = std::ranges::find(library, one["name"].get<std::string>(), &score::Problem::name);
        ASSERT_NE(problem, library.end());
        EXPECT_NEAR(one["ratio"].get<double>(), problem->upper / problem->lower, 1e-3) << one["name"];
    }
}

TEST(ScoreCall, SettingsOfAFileAreScoredAsTheSameSettingsOfARequest) {
    const std::string csv = "problem,Kp,Ti,Td\namigo/lag-delay/1/pi/1.4,0.3,1,\r\n\namigo/lag-delay/10/pi/1.4,3,8\n";
    const Json request{{"settings",
                        {{{"problem", "amigo/lag-delay/1/pi/1.4"}, {"Kp", 0.3}, {"Ti", 1}},
                         {{"problem", "amigo/lag-delay/10/pi/1.4"}, {"Kp", 3}, {"Ti", 8}}}}};
    EXPECT_EQ(Json::parse(score_request({}, csv)), request);
    const Json found = scored(request);
    ASSERT_EQ(found["problems"].size(), 2u);
    for (const Json& one : found["problems"]) EXPECT_EQ(one["controller"]["filter"]["type"], "none");
}

TEST(ScoreCall, EveryFaultNamesItsPlaceAndItsCure) {
    const auto refused = [](const Json& request, const char* pointer, const char* cure) {
        const Answer answer = score_call(request.dump(), {});
        EXPECT_EQ(answer.status, 422) << answer.body;
        EXPECT_THAT(answer.body, HasSubstr(std::string("\"pointer\":\"") + pointer + "\"")) << request;
        EXPECT_THAT(answer.body, HasSubstr(cure));
    };
    refused(Json::object(), "/tune", "Give either tune");
    refused(rule({{"method", "all"}}), "/tune", "name it");
    refused(rule({{"method", "formula"}}), "/tune/Kp", "Give a formula");
    refused(rule({{"method", "formula"}, {"Kp", "T/(2*K"}}), "/tune/Kp", "character");
    refused(rule({{"method", "formula"}, {"Kp", "T/(2*theta)"}}), "/tune/Kp", "a formula may use K, T");
    refused({{"settings", {{{"problem", "amigo/none"}, {"Kp", 1}, {"Ti", 1}}}}}, "/settings/0/problem",
            "docs/problems.md");
    refused({{"settings", {{{"problem", "amigo/lag-delay/1/pi/1.4"}, {"Kp", 1}, {"Ti", -1}}}}}, "/settings/0/Ti",
            "> 0");
    refused({{"tune", {{"method", "simc"}}}, {"problems", {{"name", "none/"}}}}, "/problems", "No problem");
}

TEST(CertificateFile, IsTheProofOfTheResultAgainWithItsLeaves) {
    const auto job = prepare_job(request_with(R"("tune": [{"method": "robust", "certify": {"gap": 0.02}}])"));
    const JobOutcome outcome = run_job(std::get<PreparedJob>(job), {});
    const Json certificate = Json::parse(outcome.result_json)["controllers"][0]["certificate"];
    const auto file = certificate_file({outcome.result_json}, "0", {});
    ASSERT_TRUE(std::holds_alternative<std::string>(file));
    std::istringstream lines(std::get<std::string>(file));
    std::string line;
    std::getline(lines, line);
    const Json head = Json::parse(line);
    EXPECT_EQ(head["goal"], certificate["lower"]);
    EXPECT_EQ(head["root"]["low"][1], certificate["root"]["low"]["ki"]);
    int leaves = 0;
    while (std::getline(lines, line)) ++leaves;
    EXPECT_EQ(leaves, head["leaves"]);
    EXPECT_GT(leaves, 10);
}

TEST(CertificateFile, AResultWithoutOneSaysHowToAsk) {
    const JobOutcome outcome =
        run_job(std::get<PreparedJob>(prepare_job(request_with(R"("tune": [{"method": "simc"}])"))), {});
    const auto file = certificate_file({outcome.result_json}, "", {});
    ASSERT_TRUE(std::holds_alternative<Problem>(file));
    EXPECT_EQ(std::get<Problem>(file).status, 404);
}

}  // namespace
}  // namespace tunewright::api
