// The form "npid": read, written, evaluated, answered by its methods.
#include <gtest/gtest.h>

#include <algorithm>

#include "api/contract/controller.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

const char* const kEvaluate =
    R"({"plant": {"type": "sopdt", "K": 1, "T1": 10, "T2": 1, "L": 2},
        "controllers": [{"form": "npid", "Kp": 3.823, "Ti": 9.9456, "Td": 1.3729},
                        {"form": "npid", "Kp": 3.823, "Ti": 9.9456, "Td": 1.3729, "delta_r": 0.1,
                         "filter": {"type": "derivative", "N": 10}}],
        "evaluate": {"points": 20, "setpoint_step": -2, "actuator": {"min": -1, "max": 1}}})";

bool warns(const Json& entry, const std::string& code) {
    return std::ranges::any_of(entry["warnings"], [&](const Json& warning) { return warning["code"] == code; });
}

TEST(NpidForm, WhatIsReadIsWritten) {
    const auto decoded = decode<Controller>(
        controller_contract(),
        R"({"form": "npid", "Kp": -2, "Ti": 5, "Td": 1, "delta_r": 0.5, "filter": {"type": "derivative", "N": 8}})");
    ASSERT_TRUE(decoded.faults.empty());
    const Json written = Json::parse(encode(controller_contract(), decoded.value));
    EXPECT_EQ(written, Json::parse(R"({"form": "npid", "Kp": -2, "Ti": 5, "Td": 1, "delta_r": 0.5, "b": 1, "c": 0,
                                       "filter": {"type": "derivative", "Tf": 0.125}, "action": "direct"})"));
    EXPECT_TRUE(schema_faults(written, "Controller").empty());
    const auto again = decode<Controller>(controller_contract(), written.dump());
    EXPECT_TRUE(again.faults.empty());
    EXPECT_EQ(encode(controller_contract(), again.value), written.dump());
}

TEST(NpidForm, IsEvaluatedWithTheStepsThatAreAskedFor) {
    const Answer answer = evaluate_call(kEvaluate, {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    EXPECT_TRUE(schema_faults(body, "EvaluateAnswer").empty());
    const Json &own = body["controllers"][0], &narrow = body["controllers"][1];
    EXPECT_EQ(own["controller"]["form"], "npid");
    EXPECT_EQ(own["controller"]["delta_r"], 2) << "the size of the set-point step";
    EXPECT_EQ(narrow["controller"]["delta_r"], 0.1);
    EXPECT_EQ(own["nonlinear"]["sector"], Json::parse("[0, 1]"));
    EXPECT_TRUE(own["nonlinear"]["circle_criterion"].get<bool>());
    EXPECT_TRUE(own["nonlinear"]["limit_cycle_amplitude"].is_null());
    EXPECT_TRUE(own["nonlinear"]["why_null"].contains("limit_cycle_amplitude"));
    EXPECT_NEAR(own["performance"]["setpoint"]["IAE"].get<double>(), 2 * 4.6098, 1e-3) << "Jin and Son (2019), Table 5";
    EXPECT_NEAR(own["equivalents"]["parallel"]["Ki"].get<double>(), 3.823 / 9.9456, 1e-12);
    for (const char* code : {"linear-part", "depends-on-step-size", "limits-not-applied"})
        EXPECT_TRUE(warns(own, code)) << code;
    EXPECT_FALSE(warns(own, "integral-stalls"));
    EXPECT_TRUE(warns(narrow, "integral-stalls"));
    EXPECT_LT(narrow["verification"]["iae_step_halving"].get<double>(), 1e-4);
}

TEST(NpidForm, ItsMethodsAnswerItAndTheBaselineMayHaveIt) {
    const auto prepared = prepare_job(
        R"({"plant": {"type": "fopdt", "K": 1, "T": 10.002, "L": 3.06},
            "tune": [{"method": "npid_ise"}, {"method": "npid_itae", "filter": {"Tf_over_Td": 0.1}},
                     {"method": "npid_iae", "optimise": true}],
            "baseline": {"form": "npid", "Kp": 2, "Ti": 10, "delta_r": 3}, "evaluate": {"points": 0}})");
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(prepared));
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), {});
    ASSERT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json body = Json::parse(outcome.result_json);
    EXPECT_TRUE(schema_faults(body, "TuningResult").empty());
    const Json& entries = body["controllers"];
    ASSERT_EQ(entries.size(), 4u);
    for (const Json& entry : entries) EXPECT_EQ(entry["controller"]["form"], "npid") << entry["method"];
    EXPECT_NEAR(entries[0]["controller"]["Kp"].get<double>(), 3.8230, 6e-5);
    EXPECT_EQ(entries[0]["controller"]["filter"]["type"], "none");
    EXPECT_EQ(entries[1]["controller"]["filter"]["type"], "derivative");
    EXPECT_EQ(entries[2]["options"]["optimise"], true);
    EXPECT_EQ(entries[3]["controller"]["delta_r"], 3);
    EXPECT_EQ(body["ranking"].size(), 4u);
}

}  // namespace
}  // namespace tunewright::api
