// Products in the contract: the members of a request, and the fields of entries.
#include <gmock/gmock.h>

#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

constexpr const char* kSpans = R"("y_span": [0, 200], "u_span": [0, 100])";

std::string implement(const std::string& members) { return R"("implement": {)" + members + "}"; }
std::string product(const std::string& id, const std::string& more = "") {
    return implement(R"("product": ")" + id + R"(", )" + kSpans + more);
}

std::string refusal(const std::string& members, const std::string& pointer) {
    const auto prepared = prepare_job(request_with(members));
    const auto* problem = std::get_if<Problem>(&prepared);
    return problem ? detail_at(problem->errors, pointer) : "accepted";
}

Json tuned(const std::string& members) {
    const JobOutcome outcome = run_job(StoredRequest{request_with(members), {}}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded) << outcome.error_json;
    const Json result = Json::parse(outcome.result_json);
    EXPECT_EQ(schema_faults(result, "TuningResult"), std::vector<std::string>{});
    return result;
}

TEST(Implement, FaultsNameThePlaceAndTheCure) {
    EXPECT_THAT(refusal(product("klippr"), "/implement/product"), HasSubstr("Did you mean klipper?"));
    EXPECT_THAT(refusal(implement(R"("product": "siemens_fb41_cont_c", "u_span": [0, 100])"), "/implement/y_span"),
                HasSubstr("y_span"));
    EXPECT_THAT(refusal(implement(R"("product": "klipper", "u_span": [100, 0])"), "/implement/u_span"),
                HasSubstr("its first number must be below the second"));
    EXPECT_THAT(refusal(implement(R"("integral": "forward")"), "/implement"),
                HasSubstr("names neither a product nor a sample_time"));
    EXPECT_THAT(refusal(product("klipper", R"(, "integral": "forward")"), "/implement/integral"),
                HasSubstr("is fixed by the product"));
    EXPECT_THAT(refusal(implement(R"("sample_time": 0)"), "/implement/sample_time"), HasSubstr("> 0"));
    EXPECT_THAT(refusal(implement(R"("sample_time": 1, "derivative": "fir")"), "/implement/derivative"),
                HasSubstr("backward or filtered"));
    EXPECT_THAT(refusal(product("klipper") + R"(, "units": {"time": "fortnight"})", "/units/time"),
                HasSubstr("not a known unit of time"));
}

TEST(Implement, SettingsThatAreNoneOfTheProductAreRefusedByName) {
    const std::string at = std::string(R"("baseline": {"product": "rockwell_pide_independent", )") + kSpans;
    EXPECT_THAT(refusal(at + R"(, "settings": {"PGain": 1, "Gain": 2}})", "/baseline/settings/Gain"),
                HasSubstr("Gain"));
    EXPECT_THAT(refusal(at + "}", "/baseline/settings"), HasSubstr("settings is missing"));
    EXPECT_THAT(refusal(R"("baseline": {"product": "nobody", "settings": {}})", "/baseline/product"),
                HasSubstr("not in the catalogue"));
}

TEST(Implement, ADesignForAProductHoldsItsLimitsOnTheLoopAsTyped) {
    const Json entry = tuned(product("emerson_deltav_series", R"(, "sample_time": 0.5)"))["controllers"][0];
    const Json& on_device = entry["implemented"];
    EXPECT_EQ(on_device["sample_time"], 0.5);
    EXPECT_LE(on_device["robustness"]["Ms"].get<double>(), 1.4 + 1e-4);
    EXPECT_LE(on_device["robustness"]["Mt"].get<double>(), 1.4 + 1e-4);
    EXPECT_GT(on_device["robustness"]["Ms"].get<double>(), 1.39);
    for (const char* name : {"GAIN", "RESET", "RATE", "ALPHA"})
        EXPECT_TRUE(entry["as_entered"]["as_typed"].contains(name));
    // The entry's controller is the ideal form of the typed settings.
    EXPECT_EQ(entry["controller"]["Kp"], entry["as_entered"]["realised"]["Kp"]);
    EXPECT_EQ(on_device["responses"]["load"]["t"].size(), 400U);
    EXPECT_TRUE(entry["longest_sample_time"].is_number());
}

TEST(Implement, ASampledProgramNeedsNoProduct) {
    const Json entry = tuned(implement(R"("sample_time": 1, "integral": "trapezoidal")"))["controllers"][0];
    EXPECT_FALSE(entry.contains("as_entered"));
    EXPECT_LE(entry["implemented"]["robustness"]["Ms"].get<double>(), 1.4 + 1e-4);
}

TEST(Implement, MovesOfMoreThanTwoPercentAreWarnedOf) {
    const Json result = tuned(implement(R"("sample_time": 2)") + R"(, "tune": [{"method": "simc"}])");
    const Json& entry = result["controllers"][0];
    ASSERT_GT(entry["implemented"]["difference"]["Ms_percent"].get<double>(), 2);
    EXPECT_EQ(entry["warnings"].back()["code"], "differs-as-built");
    // The rule of 2 % on each figure, computed from the answer's own figures.
    const Json& on_device = entry["implemented"];
    const auto overshoot = [](const Json& loop) {
        return loop["performance"]["setpoint"]["overshoot_percent"].get<double>();
    };
    const double points = on_device["difference"]["overshoot_points"].get<double>();
    EXPECT_NEAR(points, overshoot(on_device) - overshoot(entry), 1e-9);
    Json far = Json::array();
    if (std::abs(on_device["difference"]["Ms_percent"].get<double>()) > 2) far.push_back("Ms");
    if (std::abs(on_device["difference"]["load_IAE_percent"].get<double>()) > 2) far.push_back("load_IAE");
    if (std::abs(points) > 2) far.push_back("overshoot");
    EXPECT_EQ(on_device["difference"]["differs"], far);
}

TEST(Implement, ALoopThatIsBuiltAsDesignedDiffersInNothing) {
    const Json result = tuned(implement(R"("sample_time": 0.05)") + R"(, "tune": [{"method": "simc"}])");
    EXPECT_EQ(result["controllers"][0]["implemented"]["difference"]["differs"], Json::array());
}

TEST(Implement, WhatCannotBeBuiltIsSaidAndTheIdealLoopAnswered) {
    const Json result = tuned(product("klipper") + R"(, "tune": [{"method": "npid_ise"}])");
    const Json& entry = result["controllers"][0];
    EXPECT_FALSE(entry.contains("implemented"));
    EXPECT_TRUE(entry["robustness"]["stable"].get<bool>());
    EXPECT_EQ(entry["warnings"].back()["code"], "not-as-built");
}

TEST(Implement, TheNearestSettingsAreAsRobustAsTheIdealLoop) {
    const Json result = tuned(product("emerson_deltav_series") + R"(, "tune": [{"method": "ziegler_nichols_step"}])");
    const Json& entry = result["controllers"][0];
    EXPECT_EQ(entry["as_entered"]["notes"][0]["code"], "nearest-settings");
    EXPECT_LE(entry["implemented"]["robustness"]["Ms"].get<double>(), entry["robustness"]["Ms"].get<double>() + 1e-6);
    EXPECT_LE(entry["implemented"]["robustness"]["Mt"].get<double>(), entry["robustness"]["Mt"].get<double>() + 1e-6);
}

TEST(Implement, ABaselineAsTypedIsItsIdealTwin) {
    // Kp = PGain Su/Sy = 0.5, Ti = 60 PGain/IGain = 20, Td = 60 DGain/PGain = 6, all in seconds.
    const Json result = tuned(std::string(R"("baseline": {"product": "rockwell_pide_independent", )") + kSpans +
                              R"(, "sample_time": 0.1, "settings": {"PGain": 1, "IGain": 3, "DGain": 0.1}})");
    const Json& entry = result["controllers"].back();
    EXPECT_EQ(entry["method"], "baseline");
    EXPECT_NEAR(entry["controller"]["Kp"].get<double>(), 0.5, 1e-12);
    EXPECT_NEAR(entry["controller"]["Ti"].get<double>(), 20, 1e-9);
    EXPECT_NEAR(entry["controller"]["Td"].get<double>(), 6, 1e-9);
    EXPECT_EQ(entry["implemented"]["sample_time"], 0.1);
    EXPECT_EQ(entry["as_entered"]["as_typed"]["IGain"], "3.00");
}

TEST(Implement, MinutesAreTheRequestsUnitAndSecondsTheProducts) {
    const Json seconds = tuned(product("siemens_pid_compact", R"(, "sample_time": 0.6)"))["controllers"][0];
    const std::string plant = R"("plant": {"type": "fopdt", "K": 2, "T": 0.16666666666666666, "L": 0.05})";
    const JobOutcome outcome =
        run_job(StoredRequest{"{" + plant + R"(, "units": {"time": "min"}, )" +
                                  product("siemens_pid_compact", R"(, "sample_time": 0.01)") + "}",
                              {}},
                {});
    const Json minutes = Json::parse(outcome.result_json)["controllers"][0];
    for (const char* name : {"Gain", "Ti", "Td"})
        EXPECT_NEAR(minutes["as_entered"]["settings"][name].get<double>(),
                    seconds["as_entered"]["settings"][name].get<double>(),
                    2e-3 * seconds["as_entered"]["settings"][name].get<double>())
            << name;
}

}  // namespace
}  // namespace tunewright::api
