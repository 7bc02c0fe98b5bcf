// Loops with the verdict that an experienced engineer would give, and the reason.
#include <gtest/gtest.h>

#include "tests/api/support.h"
#include "tests/api/verdict/verdict_claims.h"

namespace tunewright::api {
namespace {

struct Loop {
    const char* name;
    const char* request;
    const char* head;  ///< code of the first finding
    const char* level;
    std::vector<const char*> said;    ///< codes that must be present
    std::vector<const char*> unsaid;  ///< codes that must be absent
    const char* reason;
    std::size_t entry = 0;
};

const Loop kLoops[] = {
    {"heater, loose settings today",
     R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "baseline": {"Kp": 0.3, "Ti": 20}})",
     "robust",
     "good",
     {"active-limit", "margins", "against-today", "derivative-pays"},
     {"dead-time-rules", "PI-as-good"},
     "Lag above dead time: a PID at Ms 1.4 is calm and far better for loads than sluggish PI; derivative pays at L/T "
     "0.3."},
    {"flow line that is mostly dead time",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 1, "L": 8}})",
     "robust",
     "good",
     {"dead-time-rules", "active-limit"},
     {"filter-rules"},
     "Eight lags of dead time: whatever is done, the first 8 s after a disturbance are lost; only a shorter transport "
     "helps."},
    {"level with Ziegler-Nichols",
     R"({"plant": {"type": "ipdt", "K": 0.05, "L": 2}, "tune": [{"method": "ziegler_nichols_step"}]})",
     "too-sharp",
     "bad",
     {"margins", "load-error"},
     {"active-limit", "PI-as-good"},
     "Quarter-amplitude damping gives Ms well above 2: the tank swings as soon as its gain changes."},
    {"unstable settings",
     R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "tune": [{"method": "simc"}], "baseline": {"Kp": 9, "Ti": 3}})",
     "robust",
     "good",
     {"against-today"},
     {},
     "SIMC on a first-order plant has Ms near 1.6; today's gain is several times the ultimate one, so there is nothing "
     "to compare with."},
    {"gain may double",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 4, "uncertainty": {"K": [0.5, 2.6], "L": [0.7, 2]}}, "tune": [{"method": "simc"}]})",
     "unstable-member",
     "bad",
     {"members"},
     {"active-limit"},
     "A rule for the nominal plant has a gain margin near 3; 2.6 times the gain with twice the dead time is beyond "
     "it."},
    {"the same, limits held on all",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 4, "uncertainty": {"K": [0.5, 2.6], "L": [0.7, 2]}}})",
     "robust",
     "good",
     {"members", "active-limit"},
     {"unstable-member"},
     "Designed for the worst plant: slow on the nominal one, and safe on every one; the limit is active on the worst."},
    {"cascade's two lags, no dead time",
     R"({"plant": {"type": "transfer_function", "num": [1], "den": [10, 11, 1]}})",
     "robust",
     "good",
     {"filter-rules"},
     {"dead-time-rules"},
     "Without dead time the filter of the measurement is the only thing that bounds the speed."},
    {"slow scan",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 1}, "tune": [{"method": "simc"}], "implement": {"sample_time": 4}})",
     "too-sharp",
     "bad",
     {"sample-time", "as-built"},
     {},
     "Settings for a dead time of 1 s, run every 4 s: sampling adds more delay than the plant has."},
    {"proportional control",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 2}, "tune": [{"method": "ziegler_nichols_step", "controller": "P"}]})",
     "too-sharp",
     "bad",
     {"no-integral"},
     {},
     "The P rule of Ziegler and Nichols is sharp, and without integral a load leaves a lasting error."},
    {"limits that nothing meets",
     R"({"plant": {"type": "fopdt", "K": -1, "T": -10, "L": 4}, "tune": [{"method": "robust", "Ms": 1.2, "Mt": 1.2}, {"method": "robust", "Ms": 2.5, "Mt": 2.5}], "baseline": {"Kp": 1.5, "Ti": 100}})",
     "no-controller",
     "bad",
     {"reason"},
     {"robust"},
     "An unstable lag with 0.4 of dead time has Mt above 2 with every controller: 1.2 cannot be met."},
    {"hot loop asked for",
     R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "tune": [{"method": "robust", "Ms": 1.9, "Mt": 1.9}]})",
     "little-margin",
     "warning",
     {"active-limit"},
     {"too-sharp"},
     "Ms 1.9 is what was asked for and it is held; it is still little for a plant that changes."},
    {"today's derivative hardly filtered",
     R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 1}, "tune": [{"method": "simc"}], "baseline": {"Kp": 5, "Ti": 8, "Td": 0.4, "filter": {"type": "derivative", "Tf": 0.005}}})",
     "robust",
     "good",
     {"noise-gain", "load-error"},
     {"against-today"},
     "The loop itself is calm, but N = 80 passes eighty times the noise that the proportional gain does.",
     1},
    {"a valve that is too small",
     R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "evaluate": {"actuator": {"min": -0.3, "max": 0.3}, "setpoint_step": 1, "load_step": 1}})",
     "actuator-too-small",
     "warning",
     {"at-limits", "margins"},
     {"no-integral", "not-settling"},
     "Half of u is needed for the set point and all of it for the load, and there is 0.3: no settings change that."},
    {"set points are stepped and overshoot",
     R"({"plant": {"type": "ipdt", "K": 1, "L": 1}, "tune": [{"method": "robust", "Ms": 1.5, "Mt": 1.5, "setpoint": {"weight": 1}}]})",
     "overshoot",
     "warning",
     {"margins", "load-error"},
     {"robust"},
     "Calm for loads, but on an integrating plant a PID with b = 1 overshoots by more than a quarter of each step."},
};

Json answer_to(const Loop& loop) {
    const auto outcome = run_job(std::get<PreparedJob>(prepare_job(loop.request)), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << loop.name << outcome.error_json;
    return outcome.result_json.empty() ? Json() : Json::parse(outcome.result_json);
}

TEST(VerdictOfAnEngineer, OnLoops) {
    for (const Loop& loop : kLoops) {
        const Json answer = answer_to(loop);
        if (answer.is_null()) continue;
        const Json& verdict = answer["controllers"][loop.entry]["verdict"];
        const std::string about = std::string(loop.name) + ": " + loop.reason + "\n" + verdict.dump(1);
        EXPECT_EQ(verdict[0]["code"], loop.head) << about;
        EXPECT_EQ(verdict[0]["level"], loop.level) << about;
        for (const char* code : loop.said) EXPECT_NE(finding(verdict, code), nullptr) << code << about;
        for (const char* code : loop.unsaid) EXPECT_EQ(finding(verdict, code), nullptr) << code << about;
        for (const std::string& fault : contradictions(answer, Json::parse(loop.request)))
            ADD_FAILURE() << fault << about;
    }
}

}  // namespace
}  // namespace tunewright::api
