// Today's settings from a record, through the contract.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/json/json.h"
#include "api/service.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

/// A PI program (Kp 1.5, Ti 18 s, every second) on 2 e^(-3s)/(20s+1), with steps of the set point and a wave of load.
Json closed_loop(int rows = 400, double load_size = 2, double step = 4) {
    Json record{{"dt", 1}, {"u", Json::array()}, {"y", Json::array()}, {"r", Json::array()}};
    double x = 50, integral = 0, delayed[3] = {25, 25, 25};
    for (int k = 0; k < rows; ++k) {
        const double r = k / 90 % 2 == 0 ? 50 : 50 + step, noise = 0.05 * std::sin(k * k * 0.7), y = x + noise,
                     e = r - y;
        integral += 1.5 / 18 * e;
        const double u = 25 + 1.5 * e + integral, load = load_size * std::sin(k * 0.05);
        record["u"].push_back(u);
        record["y"].push_back(y);
        record["r"].push_back(r);
        x += (1 - std::exp(-1 / 20.0)) * (2 * (delayed[k % 3] + load) - x);
        delayed[k % 3] = u;
    }
    return record;
}

Json answered(const Json& request) {
    const Answer answer = controller_record_call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return Json::parse(answer.body);
}

TEST(ControllerRecord, AnswersTheSettingsThatMovedU) {
    const Json body = answered({{"record", closed_loop()}});
    EXPECT_EQ(schema_faults(body, "ControllerRecordAnswer"), std::vector<std::string>{});
    const Json& found = body["identified"];
    EXPECT_EQ(found["controller"]["form"], "ideal");
    EXPECT_NEAR(found["controller"]["Kp"].get<double>(), 1.5, 1e-5);
    EXPECT_NEAR(found["controller"]["Ti"].get<double>(), 18, 1e-4);
    EXPECT_TRUE(found["b_known"].get<bool>());
    EXPECT_TRUE(found["standard_errors"].contains("Ti"));
    EXPECT_FALSE(body.contains("typing"));
}

TEST(ControllerRecord, AnswersThemInTheProductsForm) {
    const Json body =
        answered({{"record", closed_loop()}, {"implement", {{"product", "arduino_pid_v1"}, {"u_span", {0, 255}}}}});
    EXPECT_EQ(schema_faults(body, "ControllerRecordAnswer"), std::vector<std::string>{});
    // The library counts u from 0 to 255; its Ki is Kp/Ti per second.
    EXPECT_NEAR(body["typing"]["settings"]["Kp"].get<double>(), 1.5, 1e-5) << body["typing"].dump();
    EXPECT_NEAR(body["typing"]["settings"]["Ki"].get<double>(), 1.5 / 18, 1e-5);
    // Kd is 0 and the weights are no numbers: no errors of them.
    const Json& errors = body["typing"]["standard_errors"];
    ASSERT_EQ(errors.size(), 2u) << errors.dump();
    EXPECT_NEAR(errors["Kp"].get<double>(), body["identified"]["standard_errors"]["Kp"].get<double>(), 1e-9);
    EXPECT_GT(errors["Ki"].get<double>(), 0);
    EXPECT_TRUE(body["identified"]["certain"].get<bool>());
}

TEST(ControllerRecord, TakesTheSampleTimeOfTheProductThatRowsDoNotShow) {
    Json record = closed_loop(2000);
    for (const char* name : {"u", "y", "r"}) {
        Json every_fourth = Json::array();
        for (std::size_t k = 0; k < record[name].size(); k += 4) every_fourth.push_back(record[name][k]);
        record[name] = every_fourth;
    }
    record["dt"] = 4;
    const auto found = [&](const Json& more) {
        Json request{{"record", record}};
        request.update(more);
        return answered(request)["identified"];
    };
    const Json device{{"product", "arduino_pid_v1"}, {"u_span", {0, 255}}, {"sample_time", 1}};
    const Json from_device = found({{"implement", device}}), given = found({{"sample_time", 1}});
    EXPECT_EQ(from_device["sample_time"], 1);
    EXPECT_EQ(from_device["controller"]["Kp"], given["controller"]["Kp"]);
    EXPECT_NEAR(from_device["controller"]["Kp"].get<double>(), 1.5, 0.05);
    EXPECT_EQ(found({{"implement", device}, {"sample_time", 2}})["sample_time"], 2) << "the loop's own comes first";
}

TEST(ControllerRecord, WhatTheRecordDoesNotShowIsAsTheProductHasIt) {
    const auto typing = [](const char* product, double step) {
        const Json device{{"product", product}, {"y_span", {0, 100}}, {"u_span", {0, 100}}, {"sample_time", 1}};
        const Json body = answered({{"record", closed_loop(400, 2, step)}, {"implement", device}});
        EXPECT_EQ(body["identified"]["b_known"], step != 0);
        return body["typing"];
    };
    // The block's own weight is 0.35. Only moves of the set point contradict it.
    EXPECT_EQ(typing("omron_pid190", 0)["settings"]["alpha_code"], "165");
    EXPECT_EQ(typing("omron_pid190", 4)["settings"]["alpha_code"], "100");
    // A weight of 1 within its error needs no structure of two degrees of freedom.
    const Json deltav = typing("emerson_deltav_standard", 4);
    EXPECT_NEAR(deltav["settings"]["GAIN"].get<double>(), 1.5, 1e-3);
    EXPECT_FALSE(deltav["settings"].contains("BETA")) << deltav.dump();
    EXPECT_EQ(deltav["standard_errors"].size(), 2u) << deltav["standard_errors"].dump();
}

TEST(ControllerRecord, LeavesRowsInManualOutByTheMode) {
    Json record = closed_loop();
    Json mode = Json::array();
    // An operator moves u with every row: it does not stand still.
    for (int k = 0; k < 400; ++k) {
        const bool manual = k >= 150 && k < 250;
        if (manual) record["u"][k] = 30 + 0.2 * std::sin(0.3 * k);
        mode.push_back(manual ? "MAN" : k < 150 ? "AUTO" : k == 250 ? "CAS" : "");
    }
    record["mode"] = mode;
    const Json found = answered({{"record", record}})["identified"];
    EXPECT_NEAR(found["controller"]["Kp"].get<double>(), 1.5, 1e-5);
    EXPECT_NEAR(found["controller"]["Ti"].get<double>(), 18, 1e-4);
    EXPECT_EQ(found["manual_rows"], 100);
    EXPECT_TRUE(found["certain"].get<bool>());
    EXPECT_TRUE(found["warnings"].empty()) << found["warnings"].dump();

    for (Json& word : mode)
        if (word == "MAN") word = "HOLD";
    record["mode"] = mode;
    const Json unknown = answered({{"record", record}})["identified"];
    EXPECT_EQ(unknown["manual_rows"], 100);
    ASSERT_EQ(unknown["warnings"].size(), 1u) << unknown.dump();
    EXPECT_EQ(unknown["warnings"][0]["code"], "unknown-mode");

    mode.erase(399);
    record["mode"] = mode;
    const Answer shorter = controller_record_call(Json{{"record", record}}.dump(), {});
    EXPECT_EQ(shorter.status, 422);
    EXPECT_NE(shorter.body.find("mode has 399 words and y 400"), std::string::npos) << shorter.body;
}

TEST(ControllerRecord, SaysWhyARecordShowsNoSettings) {
    const Json few = answered({{"record", closed_loop(60)}});
    EXPECT_EQ(schema_faults(few, "ControllerRecordAnswer"), std::vector<std::string>{});
    EXPECT_FALSE(few.contains("identified")) << few.dump();
    EXPECT_NE(few.value("not_identified", "").find("80 are needed"), std::string::npos) << few.dump();
    Json test = closed_loop();
    for (std::size_t k = 0; k < test["u"].size(); ++k) test["u"][k] = k / 100 % 2 == 0 ? 20 : 25;
    const Json open_loop = answered({{"record", test}});
    EXPECT_FALSE(open_loop.contains("identified")) << open_loop.dump();
    EXPECT_NE(open_loop.value("not_identified", ""), "");
    EXPECT_EQ(controller_record_call(Json{{"record", closed_loop()}, {"sample_time", 0}}.dump(), {}).status, 422);
}

TEST(ControllerRecord, IsTheBaselineOfADesign) {
    const Json tune = Json::array({{{"method", "simc"}}});
    const Answer answer =
        design_call(Json{{"record", closed_loop(400, 0)}, {"tune", tune}, {"baseline", "from-record"}}.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json entry = Json::parse(answer.body)["controllers"].back();
    EXPECT_EQ(entry["method"], "baseline");
    EXPECT_NEAR(entry["controller"]["Kp"].get<double>(), 1.5, 1e-5);

    const Answer without = design_call(
        Json{{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 20}, {"L", 3}}}, {"baseline", "from-record"}}.dump(), {});
    EXPECT_EQ(without.status, 422);
    EXPECT_NE(without.body.find("\"/baseline\""), std::string::npos) << without.body;

    Json open = closed_loop();
    for (std::size_t k = 0; k < open["u"].size(); ++k) open["u"][k] = k / 100 % 2 == 0 ? 20 : 25;
    const Answer no_law = design_call(Json{{"record", open}, {"baseline", "from-record"}}.dump(), {});
    EXPECT_EQ(no_law.status, 422);
    EXPECT_NE(no_law.body.find("\"/baseline\""), std::string::npos) << no_law.body;
}

}  // namespace
}  // namespace tunewright::api
