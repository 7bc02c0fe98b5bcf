// POST /v1/design and /v1/frontier: answers, their form, and refusals.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::Not;

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

// y of 2 e^(-3s)/(10s + 1) after a step of u by 5 at t = 10, with noise of 0.1 that is the same in every run.
Json step_record() {
    Json record{{"dt", 0.5}, {"u", Json::array()}, {"y", Json::array()}};
    std::uint32_t state = 1;
    for (int i = 0; i < 160; ++i) {
        const double t = 0.5 * i, since = t - 13;
        state = state * 1664525u + 1013904223u;
        const double noise = 0.1 * (static_cast<double>(state >> 8) / (1 << 24) - 0.5);
        record["u"].push_back(t < 10 ? 20 : 25);
        record["y"].push_back(40 + (since > 0 ? 10 * (1 - std::exp(-since / 10)) : 0) + noise);
    }
    return record;
}

/// An answer without its durations and identifiers.
Json figures_of(Json answer) {
    for (Json& entry : answer["controllers"]) entry.erase("compute_ms");
    return {{"controllers", answer["controllers"]}, {"verdict", answer["verdict"]}, {"ranking", answer["ranking"]}};
}

Json live_answer(const Answer& answer) {
    EXPECT_EQ(answer.status, 200) << answer.body;
    return Json::parse(answer.body);
}

TEST(Design, TakesWhatAJobTakes) {
    Json request{{"units", {{"time", "min"}, {"u", "%"}}},
                 {"plant", "2 e^(-3s)/(10s+1)"},
                 {"tune", Json::array({Json{{"method", "robust"}, {"Ms", 1.5}}, Json{{"method", "simc"}}})},
                 {"baseline", {{"Kp", 0.5}, {"Ti", 10}}},
                 {"implement", {{"product", "siemens_pid_compact"}, {"y_span", {0, 200}}, {"u_span", {0, 100}}}},
                 {"evaluate", {{"setpoint_step", 5}, {"actuator", {{"min", -20}, {"max", 30}}}, {"points", 50}}}};
    for (const Json& tune : {request["tune"], Json("all")}) {
        request["tune"] = tune;
        const Json live = live_answer(design_call(request.dump(), {}));
        expect_kept(live, "DesignAnswer");
        EXPECT_EQ(figures_of(live), figures_of(design_run(request.dump())));
    }
}

TEST(Design, IsTheSameForARecordAndForTheModelThatWasFoundInIt) {
    for (const char* uncertainty : {"auto", "identified", "none"}) {
        Json request{{"record", step_record()},
                     {"uncertainty", uncertainty},
                     {"tune", Json::array({Json{{"method", "robust"}, {"Ms", 1.6}}, Json{{"method", "simc"}}})},
                     {"baseline", {{"Kp", 0.5}, {"Ti", 10}}}};
        const Json job = design_run(request.dump());
        const Json live = live_answer(design_call(request.dump(), {}));
        expect_kept(live, "DesignAnswer");
        EXPECT_EQ(figures_of(live), figures_of(job)) << uncertainty;
        EXPECT_EQ(live["model"]["plant"], job["model"]["plant"]);

        request.erase("record");
        request["model"] = job["model"];
        const Json sent_back = live_answer(design_call(request.dump(), {}));
        expect_kept(sent_back, "DesignAnswer");
        EXPECT_EQ(figures_of(sent_back), figures_of(job)) << uncertainty;
        EXPECT_FALSE(sent_back.contains("model"));
    }
}

TEST(Design, OfARecordIsEvaluatedOnItsModelWithTheRegion) {
    const Json request{{"record", step_record()}, {"baseline", {{"Kp", 0.9}, {"Ti", 10}}}};
    const Json job = design_run(request.dump());
    Json baseline = job["controllers"].back();
    ASSERT_EQ(baseline["method"], "baseline");
    const Json evaluated = live_answer(
        evaluate_call(Json{{"model", job["model"]}, {"controllers", Json::array({request["baseline"]})}}.dump(),
                      {}))["controllers"][0];
    for (const char* member : {"controller", "robustness", "performance", "region", "warnings"})
        EXPECT_EQ(evaluated[member], baseline[member]) << member;
    for (const char* member : {"code", "level"})  // the sentence names today's settings
        EXPECT_EQ(evaluated["verdict"][0][member], baseline["verdict"][0][member]) << member;
}

TEST(Design, IsAboutOneThing) {
    const Json model = design_run(Json{{"record", step_record()}}.dump())["model"];
    const Json plant{{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}};
    const auto refused = [](const Json& request) {
        const Answer answer = design_call(request.dump(), {});
        EXPECT_EQ(answer.status, 422) << answer.body;
        return answer.body;
    };
    EXPECT_THAT(refused({{"plant", plant}, {"model", model}}), HasSubstr("model and plant are both given"));
    EXPECT_THAT(refused({{"tune", "all"}}), HasSubstr("plant, record or model is missing"));
    EXPECT_THAT(refused({{"plant", plant}, {"start", {{"Kp", "x"}}}}), HasSubstr("/start/Kp"));
    EXPECT_THAT(refused({{"plant", plant}, {"timeout_s", 5}}), HasSubstr("timeout_s is not a field here"));
    Json broken = model;
    broken.erase("fit_percent");
    EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/fit_percent"));
    broken = model;
    broken["covariance"]["matrix"][0][1] = 7;
    EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/covariance/matrix"));
    broken = model;
    broken["covariance"]["matrix"][0][0] = -1;
    EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/covariance"));
    for (const auto& names : {R"(["K", "X", "L"])", R"(["K", "K", "L"])", R"(["K", "T1", "L"])"}) {
        broken = model;
        ASSERT_EQ(broken["covariance"]["names"].size(), 3u);
        broken["covariance"]["names"] = Json::parse(names);
        EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/covariance")) << names;
    }
    broken = model;
    broken.erase("covariance");
    EXPECT_THAT(refused({{"model", broken}, {"uncertainty", "identified"}}), HasSubstr("/model/covariance"));
    broken = model;
    std::swap(broken["excited_band"]["omega_low"], broken["excited_band"]["omega_high"]);
    EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/excited_band/omega_low"));
    broken = model;
    broken["plant"]["K"] = 0;
    EXPECT_THAT(refused({{"model", broken}}), HasSubstr("/model/plant/K"));
    EXPECT_EQ(prepare_job(Json{{"model", model}}.dump()).index(), 1u) << "a job keeps its record";
}

/// An asymmetry within rounding is removed; one that changes a correlation is refused.
TEST(Design, ACovarianceIsSymmetricToRounding) {
    Json model = design_run(Json{{"record", step_record()}}.dump())["model"];
    Json& matrix = model["covariance"]["matrix"];
    const double entry = matrix[0][1].get<double>();
    const double scale = std::sqrt(matrix[0][0].get<double>() * matrix[1][1].get<double>());
    const auto status = [&] { return design_call(Json{{"model", model}}.dump(), {}).status; };
    for (const double share : {1e-16, -1e-15, 1e-12}) {
        matrix[0][1] = entry + share * scale;
        EXPECT_EQ(status(), 200) << share;
    }
    matrix[0][1] = entry + 1e-6 * scale;
    EXPECT_EQ(status(), 422);
}

TEST(Design, AModelWithoutCovarianceIsHeldToItsAlternatives) {
    Json model = design_run(Json{{"record", step_record()}}.dump())["model"];
    model.erase("covariance");
    model["plant"] = {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}};
    model["alternatives"] = Json::array({{{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 9}}});
    const Json answer = Json::parse(design_call(Json{{"model", model}}.dump(), {}).body);
    ASSERT_EQ(answer["controllers"].size(), 2u);
    EXPECT_EQ(answer["controllers"][0]["over_region"], true);
    EXPECT_EQ(answer["controllers"][1]["verdict"][0]["level"], "bad");
    EXPECT_EQ(answer["controllers"][1]["verdict"][0]["code"], "model-too-uncertain");
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

TEST(Design, ACertificateBoundsTheOptimum) {
    for (const char* kind : {"PI", "PID"}) {
        const Answer answer = design(R"("tune": [{"method": "robust", "controller": ")" + std::string(kind) +
                                     R"(", "certify": {"gap": 0.01}}])");
        ASSERT_EQ(answer.status, 200) << answer.body;
        const Json live = Json::parse(answer.body);
        expect_kept(live, "DesignAnswer");
        const Json& certificate = live["controllers"][0]["certificate"];
        EXPECT_EQ(certificate["complete"], true);
        EXPECT_NEAR(certificate["gap"].get<double>(), 0.01, 1e-9);
        const double IAE = live["controllers"][0]["performance"]["load"]["IAE"];
        EXPECT_NEAR(certificate["upper"].get<double>() / IAE, 1, 1e-4);
        EXPECT_GE(certificate["lower"].get<double>(), 0.99 * IAE * (1 - 1e-4));
        EXPECT_LT(certificate["lower"].get<double>(), IAE);
        EXPECT_EQ(certificate["root"]["high"].contains("Td"), kind == std::string("PID"));
        const Json& verdict = live["controllers"][0]["verdict"];
        const auto proved = std::ranges::find(verdict, Json("proved"), [](const Json& one) { return one["code"]; });
        ASSERT_NE(proved, verdict.end());
        EXPECT_EQ((*proved)["figures"]["gap"], certificate["gap"]);
    }
}

TEST(Design, ACertificateThatCannotBeSaysWhy) {
    const Answer answer = design(R"("tune": [{"method": "robust", "Mks": 5, "certify": {"gap": 0.01}}])");
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_THAT(answer.body, HasSubstr("not-certified"));
    EXPECT_THAT(answer.body, Not(HasSubstr("\"certificate\"")));
    EXPECT_THAT(design(R"("tune": [{"method": "robust", "certify": {"gap": 0}}])").body, HasSubstr("certify/gap"));
}

}  // namespace
}  // namespace tunewright::api
