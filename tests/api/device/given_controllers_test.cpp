// Controllers that a request gives: `controllers` and `baseline` of a job, and POST /v1/evaluate.
#include <gmock/gmock.h>

#include "api/code/code.h"
#include "api/report/change_sheet.h"
#include "api/report/report.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kTyped = R"({"product": "emerson_deltav_series", "y_span": [0, 200], "u_span": [0, 100],
    "settings": {"GAIN": 1.37, "RESET": 7.3, "RATE": 1.9}})";
constexpr const char* kToday = R"({"product": "emerson_deltav_series", "y_span": [0, 200], "u_span": [0, 100],
    "settings": {"GAIN": 0.83, "RESET": 12, "RATE": 0}})";
constexpr const char* kIdeal = R"({"form": "ideal", "Kp": 0.9, "Ti": 8})";

Json result_with(const std::string& members) {
    const JobOutcome outcome = run_job(StoredRequest{request_with(members), {}}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "TuningResult"), std::vector<std::string>{});
    return result;
}

std::string controllers(const std::string& given) { return R"("controllers": [)" + given + "]"; }

std::string fault_with(const std::string& members, const std::string& pointer) {
    const auto prepared = prepare_job(request_with(members));
    const auto* problem = std::get_if<Problem>(&prepared);
    return problem ? detail_at(problem->errors, pointer) : "accepted";
}

Json typed_settings(const Json& entry) {
    Json settings = Json::object();
    for (const char* name : {"GAIN", "RESET", "RATE"}) settings[name] = entry["as_entered"]["settings"][name];
    return settings;
}

TEST(GivenControllers, AreEntriesOfAJob) {
    const Json result = result_with(controllers(std::string(kIdeal) + "," + kTyped) + R"(, "baseline": )" + kToday);
    std::vector<std::string> methods;
    for (const Json& entry : result["controllers"]) methods.push_back(entry["method"]);
    EXPECT_THAT(methods, ElementsAre("robust", "given", "given", "baseline"));
    const Json& ideal = result["controllers"][1];
    EXPECT_FALSE(ideal.contains("options"));
    EXPECT_FALSE(ideal.contains("as_entered"));
    EXPECT_EQ(ideal["controller"]["Kp"], 0.9);
    for (const char* member : {"verdict", "robustness", "performance", "responses", "standing", "longest_sample_time"})
        EXPECT_TRUE(ideal.contains(member)) << member;
}

// Each in the product into which it was typed, digit by digit, without a product of the job.
TEST(GivenControllers, AreWhatWasTypedIntoTheProduct) {
    const Json result = result_with(controllers(kTyped) + R"(, "baseline": )" + kToday);
    EXPECT_EQ(typed_settings(result["controllers"][1]), Json::parse(kTyped)["settings"]);
    EXPECT_EQ(typed_settings(result["controllers"][2]), Json::parse(kToday)["settings"]);
    EXPECT_FALSE(result["controllers"][0].contains("as_entered"));
}

TEST(GivenControllers, AreTheSameInAJobAndInAnEvaluation) {
    const Json given = result_with(controllers(std::string(kTyped) + "," + kIdeal) + R"(, "tune": [])")["controllers"];
    const auto answer = evaluate_call(R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "controllers": [)" +
                                          std::string(kTyped) + "," + kIdeal + "]}",
                                      {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json evaluated = Json::parse(answer.body)["controllers"];
    for (std::size_t i = 0; i < 2; ++i)
        for (const char* member : {"controller", "robustness", "performance", "as_entered", "implemented", "responses"})
            EXPECT_EQ(given[i].value(member, Json()), evaluated[i].value(member, Json())) << i << member;
}

TEST(GivenControllers, AreSetForTheRequestsProductIfTheyAreALaw) {
    const Json result =
        result_with(controllers(kIdeal) +
                    R"(, "implement": {"product": "emerson_deltav_series", "y_span": [0, 200], "u_span": [0, 100]})");
    const Json& typed = result["controllers"][1]["as_entered"]["settings"];
    EXPECT_NEAR(typed["GAIN"].get<double>(), 0.9 * 200 / 100, 1e-9);  // percent of the spans
    EXPECT_NEAR(typed["RESET"].get<double>(), 8, 1e-9);
}

TEST(GivenControllers, NeedNoMethod) {
    const Json result = result_with(controllers(kIdeal) + R"(, "tune": [])");
    ASSERT_EQ(result["controllers"].size(), 1U);
    EXPECT_EQ(result["proposed"], 0);
    EXPECT_THAT(fault_with(R"("tune": [], "controllers": [])", "/tune"), HasSubstr("it must have 1 to 50"));
}

TEST(GivenControllers, FaultsNameTheirPlace) {
    EXPECT_THAT(fault_with(controllers(std::string(kIdeal) + R"(, {"form": "ideal", "Kp": "x"})"), "/controllers/1/Kp"),
                HasSubstr("must be a number"));
    EXPECT_THAT(fault_with(controllers(R"({"product": "klippr", "settings": {}})"), "/controllers/0/product"),
                HasSubstr("Did you mean klipper?"));
    EXPECT_THAT(fault_with(controllers(R"({"product": "emerson_deltav_series", "settings": {"GAIN": 1}})"),
                           "/controllers/0/y_span"),
                HasSubstr("y_span"));
    EXPECT_THAT(fault_with(controllers(std::string(kTyped) + "," + kTyped) + R"(, "units": {"time": "fortnight"})",
                           "/units/time"),
                HasSubstr("not a known unit of time"));
    const auto ultimate =
        prepare_job(R"({"ultimate": {"Ku": 3, "Pu": 9}, "controllers": [)" + std::string(kIdeal) + "]}");
    ASSERT_TRUE(std::holds_alternative<Problem>(ultimate));
    EXPECT_THAT(detail_at(std::get<Problem>(ultimate).errors, "/controllers"), HasSubstr("needs a plant or a record"));
}

TEST(GivenControllers, HaveReportChangeSheetAndCode) {
    const std::string request = request_with(controllers(kTyped) + R"(, "baseline": )" + kToday);
    const std::string result = run_job(StoredRequest{request, {}}, {}).result_json;
    const ResultSource source{result, request};
    for (const auto& page : {report_html(source, "1", {}), change_sheet_html(source, "1", {})}) {
        const std::string html = std::get<std::string>(page);
        // From today's settings to the typed ones, by the names of the product, which the job itself does not name.
        EXPECT_THAT(html, HasSubstr("DeltaV"));
        for (const char* at :
             {"controllers/1/as_entered/as_typed/GAIN\">1.37<", "controllers/2/as_entered/as_typed/GAIN\">0.83<",
              "controllers/1/as_entered/as_typed/RESET\">7.3", "controllers/2/as_entered/as_typed/RESET\">12"})
            EXPECT_THAT(html, HasSubstr(at));
        EXPECT_THAT(html, Not(HasSubstr("(given)")));
    }
}

}  // namespace
}  // namespace tunewright::api
