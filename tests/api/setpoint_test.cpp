// The option setpoint and the controllers' setpoint_filter: accepted, echoed, refused.
#include <gmock/gmock.h>

#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

Json first_entry(const std::string& setpoint) {
    const Answer answer = design_call(R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
        "tune": [{"method": "robust")" + setpoint +
                                          R"(}], "evaluate": {"points": 0}})",
                                      {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    Json value = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(value, "DesignAnswer"), std::vector<std::string>{});
    return value["controllers"][0];
}

std::string refusal(const std::string& setpoint) {
    const Answer answer = design_call(R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
        "tune": [{"method": "robust", "setpoint": )" +
                                          setpoint + R"(}]})",
                                      {});
    EXPECT_EQ(answer.status, 422) << answer.body;
    return answer.body;
}

TEST(SetpointOption, IsEchoedAndKept) {
    const Json by_default = first_entry("");
    EXPECT_EQ(by_default["options"]["setpoint"], Json({{"overshoot", 5}}));
    EXPECT_LE(by_default["performance"]["setpoint"]["overshoot_percent"].get<double>(), 5);
    EXPECT_EQ(first_entry(R"(, "setpoint": {"weight": 0.4})")["controller"]["b"], 0.4);
    EXPECT_LE(
        first_entry(R"(, "setpoint": {"overshoot": 1})")["performance"]["setpoint"]["overshoot_percent"].get<double>(),
        1);
    const Json best = first_entry(R"(, "setpoint": {"best": "iae"})");
    EXPECT_LE(best["performance"]["setpoint"]["IAE"].get<double>(),
              by_default["performance"]["setpoint"]["IAE"].get<double>() * (1 + 1e-6));
    // The optimum for set points was found with b = 1.
    EXPECT_EQ(first_entry(R"(, "objective": "setpoint_iae")")["controller"]["b"], 1);
}

TEST(SetpointOption, RefusesWithPlaceAndCure) {
    EXPECT_THAT(refusal(R"({"weight": 1.5})"), HasSubstr("/tune/0/setpoint/weight"));
    EXPECT_THAT(refusal(R"({"overshoot": -1})"), HasSubstr("/tune/0/setpoint/overshoot"));
    EXPECT_THAT(refusal(R"({"overshot": 5})"), HasSubstr("overshoot"));
    EXPECT_THAT(refusal(R"({"best": "ise"})"), HasSubstr("/tune/0/setpoint/best"));
    EXPECT_THAT(refusal(R"({"weight": 0.5, "overshoot": 5})"), HasSubstr("/tune/0/setpoint"));
}

TEST(SetpointFilter, OfAGivenControllerIsEvaluatedAndAnswered) {
    const auto evaluated = [](const std::string& filter) {
        const Answer answer = evaluate_call(R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
            "controllers": [{"Kp": 1, "Ti": 10, "b": 0)" +
                                                filter + R"(}], "evaluate": {"points": 0}})",
                                            {});
        EXPECT_EQ(answer.status, 200) << answer.body;
        return Json::parse(answer.body)["controllers"][0];
    };
    const Json with = evaluated(R"(, "setpoint_filter": {"T": 4})"), without = evaluated("");
    EXPECT_EQ(with["controller"]["setpoint_filter"]["T"], 4);
    EXPECT_FALSE(without["controller"].contains("setpoint_filter"));
    // The integral of r - y grows by T.
    EXPECT_NEAR(with["performance"]["setpoint"]["IAE"].get<double>(),
                without["performance"]["setpoint"]["IAE"].get<double>() + 4, 0.3);
    EXPECT_EQ(with["performance"]["load"], without["performance"]["load"]);
    EXPECT_EQ(with["robustness"], without["robustness"]);
    const Answer bad = evaluate_call(R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3},
            "controllers": [{"Kp": 1, "Ti": 10, "setpoint_filter": {"T": -1}}]})",
                                     {});
    EXPECT_EQ(bad.status, 422);
    EXPECT_THAT(bad.body, HasSubstr("/controllers/0/setpoint_filter/T"));
}

}  // namespace
}  // namespace tunewright::api
