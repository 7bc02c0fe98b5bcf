// The user's own step in requests and answers: places of faults, absolute units, closed-form figures, and the verdict.
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "api/json/json.h"
#include "api/service.h"
#include "tests/api/support.h"
#include "tests/api/verdict/verdict_claims.h"

namespace tunewright::api {
namespace {

/// A heater of 2 degC/% with a lag of 100 s and a dead time of 10 s.
Json heater_request(const Json& own_step) {
    return {{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 100}, {"L", 10}}},
            {"units", {{"time", "s"}, {"u", "%"}, {"y", "degC"}}},
            {"controllers", Json::array({Json{{"form", "ideal"}, {"Kp", 2.5}, {"Ti", 80}}})},
            {"evaluate", {{"points", 101}, {"own_step", own_step}}}};
}

Json heater_step() { return {{"y", 20}, {"u", 0}, {"target", 120}, {"u_min", 0}, {"u_max", 100}}; }

Json own_answer_to(const Json& request) { return Json::parse(evaluate_call(request.dump(), {}).body); }

Json own_step_of(const Json& request) {
    const Json answer = own_answer_to(request);
    EXPECT_TRUE(answer.contains("controllers")) << answer.dump();
    return answer["controllers"][0]["own_step"];
}

TEST(OwnStep, IsAnsweredInTheUsersUnits) {
    const Json own = own_step_of(heater_request(heater_step()));
    const Json& trace = own["trace"];
    ASSERT_EQ(trace["t"].size(), 101u);
    EXPECT_EQ(trace["y"][0], 20);
    EXPECT_EQ(trace["r"][0], 120);
    EXPECT_NEAR(trace["y"].back().get<double>(), 120, 1.5);
    EXPECT_NEAR(own["y_final"].get<double>(), 120, 1e-6);
    EXPECT_NEAR(own["u_needed"].get<double>(), 50, 1e-9) << "100 degC over 2 degC/%";
    EXPECT_EQ(own["u_max"], 100);
    for (const Json& u : trace["u"]) {
        EXPECT_LE(u.get<double>(), 100);
        EXPECT_GE(u.get<double>(), 0);
    }
}

// With u at 100 % from t = 0 on, y is 20 + 200 (1 - exp(-(t - 10)/100)) as long as it stays there.
TEST(OwnStep, FollowsTheSaturatedPlantInClosedForm) {
    Json request = heater_request(heater_step());
    request["evaluate"]["points"] = 2001;
    const Json own = own_step_of(request);
    const double at_max = own["time_at_max"];
    EXPECT_GT(at_max, 20);
    const Json& trace = own["trace"];
    int compared = 0;
    for (std::size_t i = 0; i < trace["t"].size(); ++i) {
        const double t = trace["t"][i];
        if (t < 10 || t > at_max) continue;
        EXPECT_NEAR(trace["y"][i].get<double>(), 20 + 200 * (1 - std::exp(-(t - 10) / 100)), 1e-3);
        ++compared;
    }
    EXPECT_GT(compared, 20);
}

// Rounding keeps the loop moving: it is run for as long as it would need without, and its figures are close to those.
TEST(OwnStep, OfARoundedProgramEnds) {
    Json request = heater_request(heater_step());
    request["implement"] = {{"sample_time", 1}};
    const Json exact = own_step_of(request);
    for (const char* rounded : {"u_resolution", "y_resolution", "dead_band"}) {
        request["implement"] = {{"sample_time", 1}, {rounded, 0.05}};
        const Json own = own_step_of(request);
        EXPECT_LT(own["trace"]["t"].back().get<double>(), 2000) << rounded;
        EXPECT_TRUE(own["settles"].get<bool>()) << rounded;
        EXPECT_NEAR(own["y_final"].get<double>(), 120, 0.5) << rounded;
        ASSERT_TRUE(own["setpoint"]["IAE"].is_number()) << rounded << own["setpoint"];
        EXPECT_NEAR(own["setpoint"]["IAE"].get<double>(), exact["setpoint"]["IAE"].get<double>(),
                    0.02 * exact["setpoint"]["IAE"].get<double>())
            << rounded;
    }
}

// What was not simulated has no figures.
TEST(OwnStep, ALoadBeyondTheSimulatedTimeHasNoFigures) {
    Json step = heater_step();
    step["hold"] = 36000;
    step["load"] = {{"size", -10}};
    Json request = heater_request(step);
    request["implement"] = {{"sample_time", 0.01}};
    const Json entry = own_answer_to(request)["controllers"][0], own = entry["own_step"];
    for (const char* figure : {"IAE", "peak", "recovery_time"})
        EXPECT_TRUE(own["load"][figure].is_null()) << own["load"];
    EXPECT_TRUE(own["setpoint"]["IAE"].is_null());
    EXPECT_FALSE(own["settles"].get<bool>());
    EXPECT_EQ(entry["verdict"].dump().find("The load moves y"), std::string::npos);
}

TEST(OwnStep, AGivenLengthRestsWhereItIsLongEnough) {
    Json step = heater_step();
    for (const auto& [length, rests] : {std::pair{5.0, false}, {60.0, false}, {5000.0, true}}) {
        step["length"] = length;
        const Json own = own_step_of(heater_request(step));
        EXPECT_EQ(own["settles"].get<bool>(), rests) << length;
        EXPECT_EQ(own["y_final"].is_number(), rests) << length;
        EXPECT_TRUE(own["setpoint"]["IAE"].is_number()) << length;
        EXPECT_NEAR(own["trace"]["t"].back().get<double>(), length, 1e-9);
    }
}

// An integrating tank whose outflow exceeds what the pump can give: y falls for ever, which no controller changes.
TEST(OwnStep, OutOfReachOfAnIntegratingPlantIsBad) {
    Json request = {
        {"plant", {{"type", "ipdt"}, {"K", 0.02}, {"L", 5}}},
        {"controllers", Json::array({Json{{"form", "ideal"}, {"Kp", 3}, {"Ti", 60}}})},
        {"evaluate",
         {{"points", 0},
          {"own_step",
           {{"y", 50}, {"u", 40}, {"target", 60}, {"u_min", 0}, {"u_max", 100}, {"load", {{"size", -90}}}}}}}};
    const Json findings = own_answer_to(request)["controllers"][0]["verdict"];
    bool found = false;
    for (const Json& finding : findings)
        if (finding["code"] == "own-step-out-of-reach") {
            found = true;
            EXPECT_EQ(finding["level"], "bad");
        }
    EXPECT_TRUE(found) << findings.dump(1);
}

// The limits matter only where u reaches them: a step within them has the figures of the unit step, in proportion.
TEST(OwnStep, HasTheFiguresOfTheUnitStepWhereNothingSaturates) {
    Json request = heater_request({{"y", 20}, {"u", 10}, {"target", 30}, {"u_min", -1000}, {"u_max", 1000}});
    const Json entry = own_answer_to(request)["controllers"][0];
    const Json &own = entry["own_step"]["setpoint"], &unit = entry["performance"]["setpoint"];
    EXPECT_NEAR(own["IAE"].get<double>(), 10 * unit["IAE"].get<double>(), 2e-4 * own["IAE"].get<double>());
    EXPECT_NEAR(own["overshoot_percent"].get<double>(), unit["overshoot_percent"].get<double>(), 1e-3);
    EXPECT_NEAR(own["settling_time"].get<double>(), unit["settling_time"].get<double>(), 1e-2);
    EXPECT_NEAR(entry["own_step"]["travel"].get<double>(), 10 * unit["TV"].get<double>(), 1e-2);
    EXPECT_EQ(entry["own_step"]["time_at_max"], 0);
}

// A load step's error integral is d Ti/Kp, whatever its size; a pulse's is 0, and a load at the output -q Ti/(Kp K).
TEST(OwnStep, TheErrorAfterALoadHasItsExactIntegral) {
    Json step = {{"y", 50}, {"u", 40}, {"target", 50}, {"load", {{"size", -8}}}};
    Json own = own_step_of(heater_request(step));
    EXPECT_FALSE(own.contains("setpoint"));
    EXPECT_EQ(own["load"]["start"], 0);
    const double IAE = own["load"]["IAE"];
    EXPECT_GE(IAE, 8 * 80 / 2.5 * (1 - 1e-5));
    EXPECT_LT(own["load"]["peak"].get<double>(), 0);
    EXPECT_NEAR(own["u_needed"].get<double>(), 48, 1e-9);
    step["load"]["shape"] = "pulse";
    step["load"]["duration"] = 30;
    own = own_step_of(heater_request(step));
    EXPECT_NEAR(own["u_needed"].get<double>(), 40, 1e-9);
    EXPECT_NEAR(own["y_final"].get<double>(), 50, 1e-6);
    step["load"] = {{"size", 5}, {"at", "output"}};
    own = own_step_of(heater_request(step));
    EXPECT_NEAR(own["load"]["peak"].get<double>(), 5, 1e-9) << "y jumps at once";
    EXPECT_NEAR(own["u_needed"].get<double>(), 37.5, 1e-9);
}

TEST(OwnStep, RampHoldAndLoadFollowEachOther) {
    Json step = heater_step();
    step["ramp_rate"] = 0.5;
    step["hold"] = 300;
    step["load"] = {{"size", -10}, {"shape", "ramp"}, {"duration", 50}};
    const Json own = own_step_of(heater_request(step));
    EXPECT_EQ(own["load"]["start"], 100 / 0.5 + 300);
    for (std::size_t i = 0; i < own["trace"]["t"].size(); ++i) {
        const double t = own["trace"]["t"][i];
        EXPECT_NEAR(own["trace"]["r"][i].get<double>(), std::min(120.0, 20 + 0.5 * t), 1e-3);
    }
    EXPECT_EQ(own["time_at_max"], 0) << "the ramp is slow enough";
    // While y follows a ramp, its error is the ramp's rate over the velocity gain Kp K/Ti of the loop.
    const double lag = 0.5 * 80 / (2.5 * 2);
    for (std::size_t i = 0; i < own["trace"]["t"].size(); ++i) {
        const double t = own["trace"]["t"][i];
        if (t <= 150 || t >= 199) continue;
        EXPECT_NEAR(own["trace"]["r"][i].get<double>() - own["trace"]["y"][i].get<double>(), lag, 0.15 * lag);
    }
}

TEST(OwnStep, VerdictsNameSaturationAndATargetOutOfReach) {
    Json request = heater_request(heater_step());
    Json verdict = own_answer_to(request)["controllers"][0]["verdict"];
    const Json* saturates = finding(verdict, "own-step-saturates");
    ASSERT_NE(saturates, nullptr) << verdict.dump();
    request["evaluate"]["own_step"]["target"] = 300;
    const Json entry = own_answer_to(request)["controllers"][0];
    const Json* beyond = finding(entry["verdict"], "own-step-out-of-reach");
    ASSERT_NE(beyond, nullptr) << entry["verdict"].dump();
    EXPECT_EQ((*beyond)["level"], "warning");
    EXPECT_NEAR(entry["own_step"]["y_final"].get<double>(), 220, 1e-4) << "20 + 2 * 100";
    EXPECT_TRUE(entry["own_step"]["time_at_max"].is_null());
    EXPECT_TRUE(entry["own_step"]["setpoint"]["IAE"].is_null());
    request["evaluate"]["own_step"] = {{"y", 20}, {"u", 10}, {"target", 30}};
    verdict = own_answer_to(request)["controllers"][0]["verdict"];
    EXPECT_NE(finding(verdict, "own-step"), nullptr);
}

TEST(OwnStep, RunsAsTheUsersControllerComputesIt) {
    Json request = heater_request(heater_step());
    request["implement"] = {{"sample_time", 5}};
    const Json own = own_step_of(request);
    const Json& u = own["trace"]["u"];
    EXPECT_EQ(u[0], 100) << "the first sample is at the step";
    EXPECT_NEAR(own["y_final"].get<double>(), 120, 1e-6);
    const double continuous = own_step_of(heater_request(heater_step()))["setpoint"]["IAE"];
    EXPECT_NEAR(own["setpoint"]["IAE"].get<double>(), continuous, 0.2 * continuous);
    EXPECT_NE(own["setpoint"]["IAE"].get<double>(), continuous);
}

TEST(OwnStep, AllEntriesShareTheirTimes) {
    Json step = heater_step();
    step["load"] = {{"size", -5}};
    Json request = heater_request(step);
    request["controllers"].push_back({{"form", "ideal"}, {"Kp", 0.8}, {"Ti", 100}});
    const Json answer = own_answer_to(request);
    const Json &one = answer["controllers"][0]["own_step"], &other = answer["controllers"][1]["own_step"];
    EXPECT_EQ(one["load"]["start"], other["load"]["start"]);
    EXPECT_EQ(one["trace"]["t"], other["trace"]["t"]);
    EXPECT_LT(one["setpoint"]["IAE"].get<double>(), other["setpoint"]["IAE"].get<double>());
}

TEST(OwnStep, IsRefusedWithItsReason) {
    const auto code = [](const Json& request) -> std::string {
        return own_step_of(request).value("/refused/code"_json_pointer, "");
    };
    Json request = heater_request(heater_step());
    request["controllers"][0]["Kp"] = 100;
    EXPECT_EQ(code(request), "unstable");
    request = heater_request(heater_step());
    request["controllers"][0]["form"] = "npid";
    EXPECT_EQ(code(request), "no-law");
    request = heater_request(heater_step());
    request["controllers"][0]["Td"] = 5;
    request["evaluate"]["own_step"]["load"] = {{"size", 3}, {"at", "output"}};
    EXPECT_EQ(code(request), "impulse");
    request["evaluate"]["own_step"]["load"] = {{"size", 3}, {"at", "output"}, {"shape", "ramp"}, {"duration", 9}};
    EXPECT_EQ(code(request), "");
    request = heater_request(heater_step());
    request["plant"] = {{"type", "frequency_response"},
                        {"omega", {0.001, 0.002, 0.003, 0.006, 0.01, 0.02, 0.03, 0.1}},
                        {"re", {1.9, 1.8, 1.7, 1.3, 0.9, 0.4, 0.1, -0.1}},
                        {"im", {-0.2, -0.4, -0.6, -0.9, -1.0, -0.8, -0.6, -0.1}}};
    EXPECT_EQ(code(request), "no-time");
}

TEST(OwnStep, FaultsAreAtTheirFields) {
    struct Case {
        Json change;
        const char* pointer;
    };
    for (const Case& c : {Case{{{"u", 120}}, "u"},
                          {{{"u_max", 0}}, "u_max"},
                          {{{"target", 20}}, "target"},
                          {{{"ramp_rate", 0}}, "ramp_rate"},
                          {{{"hold", -1}}, "hold"},
                          {{{"length", 0}}, "length"},
                          {{{"target", nullptr}}, "target"},
                          {{{"load", {{"size", 0}}}}, "load/size"},
                          {{{"load", {{"size", 1}, {"shape", "pulse"}}}}, "load/duration"},
                          {{{"load", {{"size", 1}, {"at", "middle"}}}}, "load/at"},
                          {{{"slope", 1}}, "slope"}}) {
        Json step = heater_step();
        step.update(c.change);
        const Json answer = own_answer_to(heater_request(step));
        ASSERT_TRUE(answer.contains("errors")) << answer.dump();
        EXPECT_EQ(answer["errors"][0]["pointer"], std::string("/evaluate/own_step/") + c.pointer) << answer.dump();
    }
}

}  // namespace
}  // namespace tunewright::api
