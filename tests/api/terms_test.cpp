// The terms on which a job is run: the webhook at its end, its start time, and whether an earlier job may answer.
#include "api/contract/terms.h"

#include <gmock/gmock.h>

#include <chrono>
#include <ctime>
#include <iomanip>
#include <sstream>

#include "api/batch/reader.h"
#include "api/json/json.h"
#include "api/openapi/openapi.h"
#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

const std::string kNotify = R"("notify": {"url": "https://hooks.example.com/x?y=1", "secret_id": "line-1"})";

PreparedJob prepared(const std::string& members) {
    auto job = prepare_job(request_with(members));
    if (const auto* problem = std::get_if<Problem>(&job)) ADD_FAILURE() << problem->detail;
    return std::holds_alternative<PreparedJob>(job) ? std::get<PreparedJob>(std::move(job)) : PreparedJob{};
}

std::vector<FieldError> faults(const std::string& members) {
    const auto job = prepare_job(request_with(members));
    return std::holds_alternative<Problem>(job) ? std::get<Problem>(job).errors : std::vector<FieldError>();
}

TEST(JobTerms, AreTakenFromARequest) {
    const PreparedJob job = prepared(kNotify + R"(, "priority": "low")");
    ASSERT_TRUE(job.notify);
    EXPECT_EQ(job.notify->url, "https://hooks.example.com/x?y=1");
    EXPECT_EQ(job.notify->secret_id, "line-1");
    EXPECT_TRUE(job.low_priority);
    EXPECT_THAT(job.request_json, HasSubstr("hooks.example.com"));
    const PreparedJob plain = prepared(R"("notify": {"url": "https://a"}, "priority": "normal")");
    EXPECT_EQ(plain.notify->secret_id, "");
    EXPECT_FALSE(plain.low_priority);
    EXPECT_FALSE(prepared("").notify);
}

std::string in_days(int days) {
    const auto time = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
    const std::time_t at = std::chrono::system_clock::to_time_t(time + std::chrono::days(days));
    std::ostringstream text;
    text << std::put_time(std::gmtime(&at), "%Y-%m-%dT%H:%M:%SZ");
    return text.str();
}

TEST(JobTerms, SayWhenAJobMayBegin) {
    const auto at = [](const std::string& text) { return prepared("\"not_before\": \"" + text + "\"").not_before; };
    // 2026-05-04T06:00:00Z is 1,777,874,400 s after 1970 (date -u -d ... +%s).
    EXPECT_EQ(at("2026-05-04T06:00:00Z"), 1'777'874'400'000);
    EXPECT_EQ(at("2026-05-04T06:00:00.123Z"), 1'777'874'400'123);
    EXPECT_EQ(at("2026-05-04 08:00:00+02:00"), 1'777'874'400'000);
    EXPECT_EQ(at("2026-05-03T22:30-07:30"), 1'777'874'400'000);
    EXPECT_EQ(at("20260504T060000Z"), 1'777'874'400'000);
    EXPECT_EQ(at("1970-01-01T00:00:00Z"), 0) << "the past is at once";
    EXPECT_TRUE(at(in_days(29)));
    EXPECT_FALSE(prepared("").not_before);
    EXPECT_TRUE(prepared("\"unique\": true").unique);
    EXPECT_FALSE(prepared("\"unique\": false").unique || prepared("").unique);
}

TEST(JobTerms, RefuseTimesThatAreNone) {
    const auto refusal = [](const std::string& json) {
        return detail_at(faults("\"not_before\": " + json), "/not_before");
    };
    for (const char* none :
         {"\"soon\"", "\"\"", "\"2026-05-04\"", "\"06:00Z\"", "\"04.05.2026 06:00Z\"", "\"2026-02-30T06:00Z\"",
          "\"2026-05-04T25:00Z\"", "\"4/5/2026 06:00Z\"", "1777874400", "true", "[]"})
        EXPECT_THAT(refusal(none), HasSubstr("must be a time such as \"2026-05-04T06:00:00Z\"")) << none;
    EXPECT_THAT(refusal("\"2026-05-04T06:00:00\""), HasSubstr("has no zone; end it with Z"));
    EXPECT_THAT(refusal("\"" + in_days(31) + "\""), HasSubstr("more than 30 days ahead"));
    EXPECT_THAT(detail_at(faults("\"unique\": 1"), "/unique"), HasSubstr("must be true or false"));
    const auto range = prepare_range(R"({"plant": "1", "not_before": "soon"})");
    EXPECT_THAT(detail_at(std::get<Problem>(range).errors, "/not_before"), HasSubstr("must be a time"));
}

TEST(JobTerms, ChangeNeitherTheHashNorTheResult) {
    const PreparedJob plain = prepared(R"("evaluate": {"points": 0})");
    const PreparedJob termed = prepared(R"("evaluate": {"points": 0}, "priority": "low", "unique": true, )" +
                                        ("\"not_before\": \"" + in_days(1) + "\", ") + kNotify);
    EXPECT_EQ(termed.request_hash, plain.request_hash);
    EXPECT_NE(prepared(R"("evaluate": {"points": 0}, "timeout_s": 5)").request_hash, plain.request_hash);
    const JobOutcome outcome = run_job(StoredRequest{termed.request_json, termed.request_hash}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
}

TEST(JobTerms, AreRefusedWithTheirPlace) {
    EXPECT_THAT(detail_at(faults(R"("notify": {})"), "/notify/url"), HasSubstr("url is missing"));
    EXPECT_THAT(detail_at(faults(R"("notify": "https://a")"), "/notify"), HasSubstr("must be an object"));
    EXPECT_THAT(detail_at(faults(R"("notify": {"url": 5})"), "/notify/url"), HasSubstr("url is 5"));
    EXPECT_THAT(detail_at(faults(R"("notify": {"ulr": "https://a", "url": "https://a"})"), "/notify/ulr"),
                HasSubstr("did you mean url?"));
    EXPECT_THAT(detail_at(faults(R"("notify": {"url": ")" + std::string(2001, 'x') + "\"}"), "/notify/url"),
                HasSubstr("2000"));
    EXPECT_THAT(detail_at(faults(R"("notfy": {"url": "https://a"})"), "/notfy"), HasSubstr("did you mean notify?"));
    EXPECT_THAT(detail_at(faults(R"("priority": "lwo")"), "/priority"), HasSubstr("Did you mean low?"));
    EXPECT_THAT(detail_at(faults(R"("priority": 1)"), "/priority"), HasSubstr("normal or low"));
}

TEST(JobTerms, AreNotForCallsThatAreAnsweredAtOnce) {
    const std::string body = R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, )" + kNotify + "}";
    EXPECT_EQ(design_call(body, {}).status, 422);
    EXPECT_THAT(design_call(body, {}).body, HasSubstr("/notify"));
}

TEST(JobTerms, OfABatchAreNotThoseOfItsEntries) {
    const auto entry = [](const std::string& members) { return prepare_entry(request_with(members)); };
    EXPECT_THAT(detail_at(std::get<Problem>(entry(kNotify)).errors, "/notify"),
                HasSubstr("has one notification as a whole"));
    EXPECT_THAT(detail_at(std::get<Problem>(entry(R"("priority": "normal")")).errors, "/priority"),
                HasSubstr("is not possible in a batch"));
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(entry(R"("priority": "low")")));
    for (const std::string name : {"not_before", "unique"})
        EXPECT_THAT(detail_at(std::get<Problem>(entry("\"" + name + "\": true")).errors, "/" + name),
                    HasSubstr("POST /v1/jobs"));
}

/// The content and faults of a body, however the bytes are cut.
struct Read {
    std::optional<Problem> problem;
    std::optional<Notify> notify;
    std::string name;
    std::size_t entries = 0;
};

Read read(BatchQuestion question, const std::string& body, std::size_t piece) {
    BatchReader reader(std::move(question));
    std::vector<BatchEntry> entries;
    Read out;
    for (std::size_t at = 0; at < body.size() && !out.problem; at += piece)
        out.problem = reader.feed(std::string_view(body).substr(at, piece), entries);
    if (!out.problem) out.problem = reader.finish(entries);
    out.notify = reader.notify();
    out.name = reader.name();
    out.entries = entries.size();
    return out;
}

TEST(JobTerms, StandBesideTheJobsOfABatchInAnyOrder) {
    const std::string jobs = R"("jobs": [{"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "notify": {}}, {}])";
    for (const std::string& body :
         {"{" + kNotify + ", " + jobs + "}", "{" + jobs + ", " + kNotify + "}",
          "{\"name\": \"n\", " + kNotify + "," + jobs + "}", "{" + jobs + ", " + kNotify + ", \"name\": \"n\"}"})
        for (const std::size_t piece : {1UL, 7UL, 10'000UL})
            for (const bool known : {true, false}) {
                BatchQuestion question;
                if (known) question.form = BatchForm::json;
                const Read out = read(question, body, piece);
                ASSERT_FALSE(out.problem) << body << out.problem->detail;
                ASSERT_TRUE(out.notify) << body;
                EXPECT_EQ(out.notify->url, "https://hooks.example.com/x?y=1");
                EXPECT_EQ(out.notify->secret_id, "line-1");
                EXPECT_EQ(out.entries, 2u);
            }
}

TEST(JobTerms, OfABatchAreRefusedAsAWhole) {
    BatchQuestion json;
    json.form = BatchForm::json;
    const auto refusal = [&](const std::string& notify) {
        const Read out = read(json, "{\"notify\": " + notify + ", \"jobs\": [{}]}", 1000);
        return out.problem ? std::to_string(out.problem->status) + " " + out.problem->errors.at(0).pointer + " " +
                                 out.problem->detail
                           : "nothing";
    };
    EXPECT_THAT(refusal("\"https://a\""), HasSubstr("422 /notify notify must be an object"));
    EXPECT_THAT(refusal("null"), HasSubstr("422 /notify notify must be an object"));
    EXPECT_THAT(refusal("{}"), HasSubstr("422 /notify/url url is missing"));
    EXPECT_THAT(refusal("{\"url\": \"a\", \"b\": [{}]}"), HasSubstr("422 /notify/b b is not a field"));
    EXPECT_THAT(refusal("{\"url\": \"a\"}, \"notify\": {\"url\": \"a\"}"), HasSubstr("notify is given twice"));
    json.judge_notify = [](const Notify& notify) {
        Problem problem{422, "invalid-request", "", "not " + notify.url, {}, {}};
        problem.errors.push_back({"/notify/url", problem.detail});
        return problem;
    };
    EXPECT_EQ(refusal("{\"url\": \"there\"}"), "422 /notify/url not there");
    json.notify = Notify{"https://a", ""};
    EXPECT_THAT(refusal("{\"url\": \"there\"}"), HasSubstr("in the parameter notify_url"));
}

TEST(Members, AreLeftOutWhereverTheyStand) {
    const std::string json = R"({"a":[1,{"b":"}\"]","c":[[]]},-2e5],"b":{"c":1},"c":null,"d":{"b":[]}})";
    EXPECT_EQ(without_members(json, {"b"}), R"({"a":[1,{"c":[[]]},-2e5],"c":null,"d":{}})");
    EXPECT_EQ(without_members(json, {"a", "c"}), R"({"b":{},"d":{"b":[]}})");
    EXPECT_EQ(without_members(json, {"a", "b", "c", "d"}), "{}");
    EXPECT_EQ(without_members(json, {}), json);
    for (const char* same : {"", "[]", "{}", "5", "\"b\"", "[1,2]", R"(["b","c"])"})
        EXPECT_EQ(without_members(same, {"b"}), same);
    // Text that is not JSON must end, with any result.
    for (const char* broken : {"[}", "{", "{\"", "{]", "[[[", "[,", "{\"a\"", "\"\\"}) without_members(broken, {"b"});
}

TEST(Document, DescribesWhatIsSent) {
    const Json document = Json::parse(openapi_json());
    for (const char* name : {"jobEnded", "batchEnded"}) {
        const Json& content = document["webhooks"][name]["post"]["requestBody"]["content"]["application/json"];
        EXPECT_EQ(schema_faults(content["example"], content["schema"], document), std::vector<std::string>{}) << name;
    }
    EXPECT_EQ(document["components"]["schemas"]["TuningRequest"]["properties"]["priority"]["default"], "normal");
    EXPECT_EQ(document["components"]["schemas"]["Notify"]["required"], Json{"url"});
}

}  // namespace
}  // namespace tunewright::api
