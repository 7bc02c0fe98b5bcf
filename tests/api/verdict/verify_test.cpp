// Results against the second computation: all examples agree, a figure that is changed is found, and the same request
// gives the same result.
#include <algorithm>
#include <set>

#include "api/examples/examples.h"
#include "api/services/verify/verify_call.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

struct VerifiedJob {
    Json request, result;
    std::string body() const { return Json{{"request", request}, {"result", result}}.dump(); }
};

std::string result_of(const Json& request) {
    const auto prepared = prepare_job(request.dump());
    if (const auto* problem = std::get_if<Problem>(&prepared)) return problem->detail;
    return run_job(std::get<PreparedJob>(prepared), {}).result_json;
}

VerifiedJob job_of(const Json& request) { return {request, Json::parse(result_of(request))}; }

/// The requests of all examples, those about a range included, without traces, which are not compared.
std::vector<std::pair<std::string, Json>> example_requests() {
    const Json document = Json::parse(examples_json());
    std::vector<std::pair<std::string, Json>> requests;
    for (const char* list : {"examples", "ranges"})
        for (const Json& example : document.value(list, Json::array())) {
            Json request = example["request"];
            if (!request.contains("points") && !request.contains("range")) request["evaluate"]["points"] = 0;
            requests.emplace_back(example["id"].get<std::string>(), request);
        }
    return requests;
}

/// The examples with their results, computed once for all tests.
const std::vector<std::pair<std::string, VerifiedJob>>& example_jobs() {
    static const auto jobs = [] {
        std::vector<std::pair<std::string, VerifiedJob>> all;
        for (const auto& [id, request] : example_requests()) all.emplace_back(id, job_of(request));
        return all;
    }();
    return jobs;
}

VerifyAnswer verified(const VerifiedJob& job) {
    auto answer = verify_result({job.body()}, {});
    if (const auto* problem = std::get_if<Problem>(&answer)) {
        ADD_FAILURE() << problem->detail;
        return {};
    }
    return std::get<VerifyAnswer>(std::move(answer));
}

bool differs(const VerifyAnswer& answer, const std::string& where) {
    const auto found = std::ranges::find(answer.figures, where, &VerifiedFigure::where);
    return found != answer.figures.end() && !found->agrees;
}

TEST(Verify, NoFigureOfAnExampleDiffers) {
    std::size_t compared = 0, examples = 0;
    for (const auto& [id, job] : example_jobs()) {
        const VerifyAnswer answer = verified(job);
        for (const VerifiedFigure& one : answer.figures)
            EXPECT_TRUE(one.agrees) << id << one.where << ": " << one.given << " and " << one.found;
        EXPECT_FALSE(answer.figures.empty()) << id;
        compared += answer.figures.size();
        ++examples;
    }
    EXPECT_GE(examples, 19u);
    EXPECT_GT(compared, 1200u);
}

/// A value that is wrong by 1 %, or where that is nothing, by 1.
Json wrong(const Json& value) {
    if (value.is_boolean()) return !value.get<bool>();
    if (!value.is_number() || value.get<double>() == 0) return 1;
    return 1.01 * value.get<double>();
}

/// Overshoots are compared as y over r: 1 % of one below 0.1 % is below the accuracy of y.
bool can_be_seen(const VerifiedFigure& figure) {
    return !figure.where.ends_with("overshoot_percent") || !figure.given.is_number() || figure.given == 0 ||
           figure.given.get<double>() > 0.2;
}

TEST(Verify, EachFigureOfALoopThatIsChangedByOnePercentIsFound) {
    const VerifiedJob job =
        job_of({{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                {"tune", {{{"method", "robust"}, {"controller", "PI"}, {"certify", {{"gap", 0.2}}}}}},
                {"evaluate", {{"points", 0}, {"noise", {{"std", 0.1}}}}}});
    const VerifyAnswer right = verified(job);
    ASSERT_EQ(right.differing(), 0);
    ASSERT_GT(right.figures.size(), 30u);
    for (const VerifiedFigure& figure : right.figures) {
        if (!can_be_seen(figure)) continue;
        VerifiedJob changed = job;
        Json& value = changed.result[Json::json_pointer(figure.where)];
        // A bound is wrong if it is above the IAE.
        value = figure.where.ends_with("/lower") ? Json(2 * value.get<double>()) : wrong(value);
        EXPECT_TRUE(differs(verified(changed), figure.where)) << figure.where;
    }
}

TEST(Verify, AllFiguresOfTheExamplesThatAreChangedByOnePercentAreFound) {
    for (const auto& [id, right] : example_jobs()) {
        VerifiedJob job = right;
        std::vector<std::string> seen;
        for (const VerifiedFigure& figure : verified(job).figures) {
            // Without stability there are no other figures.
            if (!can_be_seen(figure) || figure.given.is_boolean()) continue;
            seen.push_back(figure.where);
            Json& value = job.result[Json::json_pointer(figure.where)];
            value = wrong(value);
        }
        const VerifyAnswer answer = verified(job);
        for (const std::string& where : seen) EXPECT_TRUE(differs(answer, where)) << id << where;
    }
}

TEST(Verify, EveryPartOfAnEntryIsComparedOrNamedAsNotVerified) {
    // Settings and sentences have no figures of their own; verification has estimates of errors.
    const std::set<std::string> without_figures = {
        "method",      "title",      "source",       "options",     "verdict",     "warnings",  "controller",
        "equivalents", "compute_ms", "verification", "over_region", "region_cost", "as_entered"};
    for (const auto& [id, job] : example_jobs()) {
        const VerifyAnswer answer = verified(job);
        const Json entries = job.result.value("controllers", Json::array());
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (entries[i].contains("error")) continue;
            for (const auto& [name, part] : entries[i].items()) {
                const std::string where = "/controllers/" + std::to_string(i) + "/" + name;
                const auto names = [&](const auto& one) {
                    return one.where == where || one.where.starts_with(where + "/");
                };
                EXPECT_TRUE(without_figures.contains(name) || std::ranges::any_of(answer.figures, names) ||
                            std::ranges::any_of(answer.not_verified, names))
                    << id << where;
            }
        }
    }
}

TEST(Verify, TheAnswerFitsTheDocument) {
    const VerifiedJob job = job_of(Json::parse(request_with(R"("tune": [{"method": "simc"}])")));
    const Answer answer = verify_call(job.body(), {});
    ASSERT_EQ(answer.status, 200);
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(body, "VerifyAnswer"), std::vector<std::string>{});
    EXPECT_TRUE(body["agrees"].get<bool>());
    EXPECT_EQ(body["compared"], body["figures"].size());
}

TEST(Verify, AResultOfAnEvaluationIsVerifiedToo) {
    const Json request = {{"plant", {{"type", "ipdt"}, {"K", 0.05}, {"L", 4}}},
                          {"controllers", {{{"Kp", 1.5}, {"Ti", 30}}, {{"Kp", 50}, {"Ti", 30}}}},
                          {"evaluate", {{"horizon", 100}, {"setpoint_step", -2}, {"points", 0}}}};
    const VerifyAnswer answer = verified({request, Json::parse(evaluate_call(request.dump(), {}).body)});
    EXPECT_EQ(answer.differing(), 0);
    const auto second = std::ranges::find(answer.figures, "/controllers/1/robustness/stable", &VerifiedFigure::where);
    ASSERT_NE(second, answer.figures.end());
    EXPECT_FALSE(second->found.get<bool>()) << "an unstable loop is verified as unstable";
}

TEST(Verify, AnotherPlantInTheRequestIsFound) {
    VerifiedJob job = job_of(Json::parse(request_with(R"("tune": [{"method": "simc"}])")));
    job.request["plant"]["K"] = 2.001;
    EXPECT_GT(verified(job).differing(), 10);
}

TEST(Verify, WhatCannotBeReadIsRefused) {
    const VerifiedJob job = job_of(Json::parse(request_with(R"("tune": [{"method": "simc"}])")));
    EXPECT_EQ(verify_call("{", {}).status, 400);
    EXPECT_EQ(verify_call("{}", {}).status, 422);
    EXPECT_EQ(verify_call(job.result.dump(), {}).status, 422) << "the request is missing";
    EXPECT_EQ(verify_call(Json{{"request", {{"plant", 1}}}, {"result", job.result}}.dump(), {}).status, 422);
    for (const char* member : {"robustness", "performance", "controller", "verification"}) {
        VerifiedJob broken = job;
        broken.result["controllers"][0][member] = "text";
        EXPECT_LE(verify_call(broken.body(), {}).status, 422) << member;
    }
}

TEST(Results, OfTheSameRequestAreTheSameBytes) {
    const auto kept = [](const std::string& result) {
        return without_members(result, {"compute_ms", "seconds", "version"});
    };
    for (const auto& [id, job] : example_jobs())
        EXPECT_EQ(kept(job.result.dump()), kept(Json::parse(result_of(job.request)).dump())) << id;
}

}  // namespace
}  // namespace tunewright::api
