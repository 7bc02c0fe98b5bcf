// POST /v1/range and jobs about a range: answers against the document and each other.
#include <gmock/gmock.h>

#include "api/contract/range/range_experiments.h"
#include "api/report/report.h"
#include "api/services/range_service.h"
#include "engine/tuning/limits.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

Json three_loads() {
    return {{"scheduling", {{"name", "load"}, {"unit", "%"}}},
            {"points", Json::array({Json{{"at", 30}, {"plant", {{"type", "fopdt"}, {"K", 4}, {"T", 20}, {"L", 4}}}},
                                    Json{{"at", 60}, {"plant", "2 e^(-3s)/(12s+1)"}},
                                    Json{{"at", 100}, {"plant", {{"type", "fopdt"}, {"K", 1}, {"T", 8}, {"L", 2}}}}})},
            {"schedule", {{"controller", "PI"}}}};
}

Json cone() {
    return {{"plant",
             {{"type", "nonlinear"},
              {"states", {{"h", 20}}},
              {"parameters", {{"c", 40}, {"a", 0.2827433388}}},
              {"equations", {{"h", "(q - c*sqrt(h))/(a*h^2)"}}},
              {"input", {{"name", "q"}, {"nominal", 178.8854382}, {"min", 0}, {"max", 400}}},
              {"output", "h"},
              {"L", 2}}},
            {"range", {{"along", "output"}, {"from", 10}, {"to", 32}}}};
}

Json answered(const Json& request) {
    const Answer answer = range_call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return Json::parse(answer.body);
}

TEST(RangeCall, TheAnswerFitsTheDocumentAndTheScheduleHoldsItsLimitsAndAllowance) {
    const Json answer = answered(three_loads());
    EXPECT_EQ(schema_faults(answer, "RangeCallAnswer"), std::vector<std::string>{});
    const Json& range = answer["range"];
    EXPECT_EQ(range["scheduling"], (Json{{"name", "load"}, {"unit", "%"}, {"from", 30}, {"to", 100}}));
    EXPECT_TRUE(range["schedule"]["holds_limits"]);
    EXPECT_TRUE(range["schedule"]["within_allowance"]);
    const std::size_t places = range["curves"]["at"].size();
    EXPECT_GE(places, 61u);
    for (const char* which : {"one", "schedule"})
        for (const char* figure : {"Ms", "Mt", "relative_IAE"}) {
            const Json& curve = range["curves"][which][figure];
            ASSERT_EQ(curve.size(), places) << which << " " << figure;
        }
    for (std::size_t i = 0; i < places; ++i) {
        EXPECT_LE(range["curves"]["schedule"]["Ms"][i].get<double>(), 1.4001) << range["curves"]["at"][i];
        EXPECT_LE(range["curves"]["schedule"]["relative_IAE"][i].get<double>(), 1.051) << range["curves"]["at"][i];
    }
    for (const Json& worst : range["worst"]["schedule"]) {
        if (worst["quantity"] == "Ms") {
            EXPECT_EQ(worst["limit"], limits::kDefaultMs) << "none was asked for";
        }
    }
    EXPECT_EQ(range["curves"]["K"].front(), 4);
    EXPECT_EQ(range["curves"]["T"].back(), 8);
    EXPECT_EQ(range["verdict"]["code"], "schedule-pays");
    EXPECT_GT(range["one"]["worst_relative_IAE"].get<double>(), 1.3);
}

TEST(RangeCall, TheVerdictOnAGivenScheduleFollowsFromItsFigures) {
    Json request = three_loads();
    const Json rows = answered(request)["range"]["schedule"]["rows"];
    for (const double factor : {0.5, 1.0, 2.0}) {
        SCOPED_TRACE(factor);
        request["schedule"]["given"] = rows;
        for (Json& row : request["schedule"]["given"]) row["Kp"] = factor * row["Kp"].get<double>();
        const Json range = answered(request)["range"];
        const Json &schedule = range["schedule"], &verdict = range["verdict"];
        const bool holds = schedule["holds_limits"], cheap = schedule["within_allowance"];
        EXPECT_EQ(holds, factor <= 1);
        EXPECT_EQ(cheap, factor >= 1);
        EXPECT_EQ(verdict["code"], !holds ? "schedule-exceeds" : cheap ? "schedule-holds" : "schedule-costs");
        EXPECT_EQ(verdict["level"], !holds ? "bad" : cheap ? "good" : "warning");
        EXPECT_EQ(verdict["figures"]["schedule_worst_relative_IAE"], schedule["worst_relative_IAE"]);
    }
}

TEST(RangeCall, AGivenScheduleIsJudgedAsTheDesignJudgedIt) {
    Json request = three_loads();
    const Json designed = answered(request)["range"];
    request["schedule"]["given"] = designed["schedule"]["rows"];
    const Json given = answered(request)["range"];
    EXPECT_EQ(schema_faults(given, "Range"), std::vector<std::string>{});
    EXPECT_TRUE(given["one"].is_null());
    EXPECT_THAT(given["why_null"]["one"].get<std::string>(), HasSubstr("given"));
    EXPECT_EQ(given["verdict"]["code"], "schedule-holds");
    EXPECT_EQ(given["verdict"]["level"], "good");
    EXPECT_EQ(given["verdict"]["figures"]["rows"], designed["schedule"]["rows"].size());
    EXPECT_EQ(given["verdict"]["figures"]["schedule_worst_relative_IAE"], given["schedule"]["worst_relative_IAE"]);
    EXPECT_FALSE(given["curves"].contains("one"));
    EXPECT_EQ(given["schedule"]["rows"], designed["schedule"]["rows"]);
    EXPECT_TRUE(given["schedule"]["holds_limits"]);
    // The optima are interpolated between fewer places.
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(given["worst"]["schedule"][i]["value"].get<double>(),
                    designed["worst"]["schedule"][i]["value"].get<double>(), 5e-3);
}

TEST(RangeCall, OfEquationsAnswersSteadyStatesAndRunsInWhichNothingJumps) {
    const Json range = answered(cone())["range"];
    EXPECT_EQ(schema_faults(range, "Range"), std::vector<std::string>{});
    EXPECT_EQ(range["scheduling"]["name"], "y");
    const Json& curves = range["curves"];
    for (std::size_t i = 0; i < curves["at"].size(); ++i) {
        const double h = curves["y"][i];
        EXPECT_NEAR(curves["u"][i].get<double>(), 40 * std::sqrt(h), 1e-3);
        EXPECT_NEAR(curves["K"][i].get<double>(), 2 * std::sqrt(h) / 40, 1e-5);
    }
    ASSERT_EQ(range["runs"].size(), 4u);
    for (const Json& run : range["runs"]) {
        EXPECT_LT(run["schedule"]["largest_bump"].get<double>(), 1e-9) << run["name"];
        EXPECT_TRUE(run["schedule"]["settled"]) << run["name"];
        EXPECT_LT(run["schedule"]["IAE"], run["one"]["IAE"]) << run["name"];
    }
    Json quiet = cone();
    quiet["runs"] = false;
    EXPECT_FALSE(answered(quiet)["range"].contains("runs"));
}

TEST(RangeJob, IsTheCallWithItsTermsAndTheSameForEverySpellingOfAPlant) {
    Json request = three_loads();
    request["name"] = "TIC-7";
    request["units"] = {{"time", "s"}};
    const auto prepared = prepare_job(request.dump());
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(prepared));
    const auto& job = std::get<PreparedJob>(prepared);
    EXPECT_EQ(job.name, "TIC-7");
    const JobOutcome outcome = run_job(job, {}),
                     stored = run_job(StoredRequest{job.request_json, job.request_hash}, {});
    ASSERT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    EXPECT_EQ(outcome.result_json, stored.result_json);
    EXPECT_EQ(outcome.method, "range");
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "RangeResult"), std::vector<std::string>{});
    EXPECT_EQ(schema_faults(Json::parse(outcome.outline_json), "JobOutline"), std::vector<std::string>{});
    EXPECT_EQ(result["range"]["schedule"], answered(three_loads())["range"]["schedule"]);
    request["points"][1]["plant"] = {{"type", "fopdt"}, {"K", 2}, {"T", 12}, {"L", 3}};
    EXPECT_EQ(std::get<PreparedJob>(prepare_job(request.dump())).request_hash, job.request_hash);
}

TEST(RangeJob, HasAReportWithItsSettingsRunsAndRequest) {
    const auto prepared = std::get<PreparedJob>(prepare_job(cone().dump()));
    const JobOutcome outcome = run_job(prepared, {});
    const Json range = Json::parse(outcome.result_json)["range"];
    const auto report = report_html({outcome.result_json, prepared.request_json}, "",
                                    {.job = "", .name = "cone", .date = "", .origin = "", .utc_offset_min = {}});
    ASSERT_TRUE(std::holds_alternative<std::string>(report));
    const std::string& page = std::get<std::string>(report);
    EXPECT_THAT(page, HasSubstr("cone: tuning report"));
    EXPECT_THAT(page, HasSubstr("One setting costs up to 22.1 times the IAE"));
    for (std::size_t k = 0; k < range["schedule"]["rows"].size(); ++k)
        EXPECT_THAT(page, HasSubstr("data-at=\"/result/range/schedule/rows/" + std::to_string(k) + "/Kp\""));
    EXPECT_THAT(page, HasSubstr("Nonlinear controller"));
    EXPECT_THAT(page, HasSubstr("<pre id=\"request\">"));
    EXPECT_TRUE(std::holds_alternative<Problem>(report_html({outcome.result_json}, "0", {})));
}

TEST(RangeJob, TellsItsProgressAndKeepsTheBestSoFarWhenItIsStopped) {
    const auto prepared = prepare_job(cone().dump());
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(prepared));
    std::stop_source stop;
    double last = 0;
    RunControl control;
    control.stop = stop.get_token();
    control.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last);
        last = progress.fraction;
        if (progress.best) stop.request_stop();
    };
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), control);
    ASSERT_EQ(outcome.status, JobOutcome::Status::cancelled);
    const Json result = Json::parse(outcome.result_json);
    EXPECT_TRUE(result["partial"]);
    EXPECT_TRUE(result["range"]["one"].is_object());
    EXPECT_TRUE(result["range"]["schedule"].is_null());
}

TEST(RangeExperiments, GiveRecordsFromWhichTheRangeIsDesigned) {
    Json question = cone();
    question["experiment"] = {{"kind", "step"}, {"at", {10, 20, 32}}};
    const Answer answer = range_experiments_call(question.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json tests = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(tests, "RangeExperiments"), std::vector<std::string>{});
    Json request = {{"points", Json::array()}};
    for (const Json& test : tests["tests"])
        request["points"].push_back({{"at", test["at"]}, {"record", test["record"]}});
    const Json range = answered(request)["range"];
    EXPECT_EQ(schema_faults(range, "Range"), std::vector<std::string>{});
    ASSERT_EQ(range["points"].size(), 3u);
    for (const Json& point : range["points"]) {
        EXPECT_GT(point["model"]["fit_percent"].get<double>(), 90);
        EXPECT_EQ(point["plant"]["type"], range["points"][0]["plant"]["type"]);
    }
}

struct Refused {
    const char* name;
    const char* pointer;
    const char* sentence;
    std::function<void(Json&)> spoil;
    bool equations = false;
};

class RangeRefuses : public testing::TestWithParam<Refused> {};

TEST_P(RangeRefuses, WithTheFieldAndTheCure) {
    Json request = GetParam().equations ? cone() : three_loads();
    GetParam().spoil(request);
    const Answer answer = range_call(request.dump(), {});
    ASSERT_EQ(answer.status, 422) << answer.body;
    const Json problem = Json::parse(answer.body);
    ASSERT_TRUE(problem.contains("errors")) << answer.body;
    std::string details;
    for (const Json& error : problem["errors"])
        if (error["pointer"] == GetParam().pointer) details += error["detail"].get<std::string>();
    EXPECT_THAT(details, HasSubstr(GetParam().sentence)) << answer.body;
}

INSTANTIATE_TEST_SUITE_P(
    All, RangeRefuses,
    testing::Values(
        Refused{"PointsOutOfOrder", "/points/1/at", "ascending order", [](Json& r) { r["points"][1]["at"] = 10; }},
        Refused{"AStructureOfItsOwn", "/points/1/plant", "differ in structure",
                [](Json& r) { r["points"][1]["plant"] = "2 e^(-3s)/((12s+1)(2s+1))"; }},
        Refused{"APointWithoutAPlant", "/points/2", "neither plant nor record",
                [](Json& r) { r["points"][2].erase("plant"); }},
        Refused{"OnePointAlone", "/points", "2 to 20", [](Json& r) { r["points"] = Json::array({r["points"][0]}); }},
        Refused{"PointsAndEquations", "/plant", "Remove one", [](Json& r) { r["plant"] = "1/(s+1)"; }},
        Refused{"RegionWithoutRecords", "/uncertainty", "needs records",
                [](Json& r) { r["uncertainty"] = "identified"; }},
        Refused{"RowsOutOfOrder", "/schedule/given/1/at", "Sort them",
                [](Json& r) {
                    r["schedule"]["given"] = {{{"at", 60}, {"Kp", 1}, {"Ti", 9}}, {{"at", 30}, {"Kp", 1}, {"Ti", 9}}};
                }},
        Refused{"TooManyRows", "/schedule/rows", "<= 20", [](Json& r) { r["schedule"]["rows"] = 21; }},
        Refused{"AnUnknownParameter", "/range/parameter", "kk",
                [](Json& r) {
                    r["range"] = {{"along", "parameter"}, {"parameter", "kk"}, {"from", 1}, {"to", 2}};
                },
                true},
        Refused{"AnEmptyRange", "/range/to", "> from", [](Json& r) { r["range"]["to"] = 5; }, true},
        Refused{"EquationsWithoutARange", "/range", "range is missing", [](Json& r) { r.erase("range"); }, true},
        Refused{"BeyondTheInput", "/range/to", "limits", [](Json& r) { r["range"]["to"] = 200; }, true}),
    [](const auto& one) { return one.param.name; });

TEST(RangeCall, ARecordThatIsNotIdentifiableNamesItsPoint) {
    Json request = three_loads();
    Json flat = {{"dt", 1}, {"u", Json::array()}, {"y", Json::array()}};
    for (int i = 0; i < 50; ++i) {
        flat["u"].push_back(i < 10 ? 0 : 1);
        flat["y"].push_back(0);
    }
    request["points"][1] = {{"at", 60}, {"record", flat}};
    const Answer answer = range_call(request.dump(), {});
    ASSERT_EQ(answer.status, 422) << answer.body;
    const Json problem = Json::parse(answer.body);
    EXPECT_THAT(problem["type"].get<std::string>(), HasSubstr("not-identifiable"));
    EXPECT_THAT(problem["detail"].get<std::string>(), HasSubstr("load = 60"));
}

TEST(RangeCall, AFoldInTheRangeIsNamedWithItsPlace) {
    const Json request = {
        {"plant",
         {{"type", "nonlinear"},
          {"states", {{"CA", 8.564}, {"T", 311.2}}},
          {"parameters",
           {{"k0", 34930800}, {"E", 11843}, {"Rg", 1.987}, {"CAf", 10}, {"Tf", 298}, {"J", 11.92}, {"UA", 0.3}}},
          {"equations",
           {{"CA", "CAf - CA - k0*exp(-E/(Rg*T))*CA"}, {"T", "Tf - T + J*k0*exp(-E/(Rg*T))*CA + UA*(Tc - T)"}}},
          {"input", {{"name", "Tc"}, {"nominal", 298}, {"min", 200}, {"max", 400}}},
          {"output", "T"},
          {"L", 0.02}}},
        {"range", {{"along", "input"}, {"from", 290}, {"to", 320}}}};
    const Answer answer = range_call(request.dump(), {});
    ASSERT_EQ(answer.status, 422) << answer.body;
    EXPECT_THAT(answer.body, HasSubstr("turns back at Tc"));
    EXPECT_THAT(answer.body, HasSubstr("\"/range"));
}

}  // namespace
}  // namespace tunewright::api
