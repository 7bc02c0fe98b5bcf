// The replay of a record through the contract: with a design and with controllers that the request gives.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/json/json.h"
#include "api/service.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

struct PiProgram {
    double Kp, Ti;
};
constexpr PiProgram kUsed{1.5, 18};

/// An hour of 2 e^(-3s)/(20s+1) under a PI program that runs every second: steps of the set point, a wave of the load
/// and ripple on y, whatever the program.
struct Hour {
    std::vector<double> t, u, y, r;
    double IAE = 0;
};

Hour hour_with(const PiProgram& program) {
    Hour hour;
    double x = 50, integral = 0, delayed[3] = {25, 25, 25};
    for (int k = 0; k < 900; ++k) {
        const double r = k / 90 % 2 == 0 ? 50 : 54, y = x + 0.02 * std::sin(k * k * 0.7), e = r - y;
        integral += program.Kp / program.Ti * e;
        const double u = 25 + program.Kp * e + integral, load = 0.1 * std::sin(k * 0.05);
        hour.t.push_back(k);
        hour.u.push_back(u);
        hour.y.push_back(y);
        hour.r.push_back(r);
        hour.IAE += std::abs(e);
        x += (1 - std::exp(-1 / 20.0)) * (2 * (delayed[k % 3] + load) - x);
        delayed[k % 3] = u;
    }
    return hour;
}

Json law_of(const PiProgram& program) { return {{"form", "ideal"}, {"Kp", program.Kp}, {"Ti", program.Ti}}; }

Json designed(const Hour& hour, const Json& more) {
    Json request{{"record", {{"t", hour.t}, {"u", hour.u}, {"y", hour.y}, {"r", hour.r}}},
                 {"evaluate", {{"points", 50}}}};
    request.update(more);
    const Answer answer = design_call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body, nullptr, false);
    EXPECT_EQ(schema_faults(body, "DesignAnswer"), std::vector<std::string>{});
    return body;
}

TEST(Replay, OfGivenControllersIsTheHourThatTheyWouldHaveMade) {
    const PiProgram slow{0.6, 20};
    const Hour hour = hour_with(kUsed);
    const double truth = hour_with(slow).IAE / hour.IAE;
    ASSERT_GT(truth, 1.3) << "other settings make another hour";
    const Json typed{{"product", "arduino_pid_v1"},
                     {"u_span", {0, 255}},
                     {"sample_time", 1},
                     {"settings", {{"Kp", kUsed.Kp}, {"Ki", kUsed.Kp / kUsed.Ti}, {"Kd", 0}}}};
    const Json body = designed(hour, {{"tune", Json::array({{{"method", "simc"}}})},
                                      {"controllers", Json::array({law_of(kUsed), law_of(slow), typed})}});
    ASSERT_TRUE(body["replay"].contains("figures")) << body["replay"].dump();
    EXPECT_NEAR(body["replay"]["figures"]["IAE"].get<double>(), hour.IAE, 0.01 * hour.IAE);

    const Json& entries = body["controllers"];
    ASSERT_EQ(entries.size(), 4U);
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_EQ(entries[i]["method"], "given");
        const Json& replay = entries[i]["replay"];
        ASSERT_TRUE(replay.contains("IAE_ratio")) << replay.dump();
        const double wanted = i == 2 ? truth : 1;
        EXPECT_NEAR(replay["IAE_ratio"].get<double>(), wanted, 0.1 * wanted) << i;
        EXPECT_LE(replay["IAE_ratio_low"].get<double>(), wanted) << i;
        EXPECT_GE(replay["IAE_ratio_high"].get<double>(), wanted) << i;
        EXPECT_EQ(replay["y"].size(), body["replay"]["t"].size());
    }
    EXPECT_TRUE(entries[0]["replay"].contains("IAE_ratio")) << "the design too";
}

TEST(Replay, OfAnUnstableGivenControllerIsRefusedAndTheOthersAreNot) {
    const Json body = designed(
        hour_with(kUsed), {{"tune", Json::array()}, {"controllers", Json::array({law_of({60, 1}), law_of(kUsed)})}});
    EXPECT_EQ(body["controllers"][0]["replay"]["refused"]["code"], "unstable") << body["controllers"][0].dump();
    EXPECT_FALSE(body["controllers"][0]["replay"].contains("IAE_ratio"));
    EXPECT_TRUE(body["controllers"][1]["replay"].contains("IAE_ratio"));
}

}  // namespace
}  // namespace tunewright::api
