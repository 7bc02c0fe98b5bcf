// POST /v1/experiments/relay: answers checked against the document, and refusals.
#include <gmock/gmock.h>

#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

const Json kFirstOrder = {{"type", "fopdt"}, {"K", 1}, {"T", 10}, {"L", 2}};

Answer call(const Json& plant, const Json& relay) {
    return relay_call(Json{{"plant", plant}, {"relay", relay}}.dump(), {});
}

TEST(RelayCall, TheAnswerFitsTheDocumentAndCarriesTheSteadyCycle) {
    const Answer answer = call(kFirstOrder, {{"hysteresis", 0.2}, {"cycles", 4}, {"shift", 0.1}});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(body, "RelayAnswer"), std::vector<std::string>{});
    EXPECT_NEAR(body["limit_cycle"]["Pu"], 14.39098, 1e-5);
    EXPECT_NEAR(body["limit_cycle"]["shift"]["A"], 0.1704858, 1e-6);
    EXPECT_EQ(body["record"]["t"].size(), body["record"]["y"].size());
    EXPECT_EQ(body["record"]["t"].size(), body["record"]["u"].size());
    EXPECT_GT(body["record"]["t"].size(), 700u);
    EXPECT_EQ(body["reversed"], false);
    EXPECT_GT(body["plan"]["reason"].get<std::string>().size(), 30u);
}

TEST(RelayCall, TheRecordIsAcceptedByIdentifyUnchanged) {
    const Answer answer = call(kFirstOrder, {{"u_plus", 1.3}, {"u_minus", -0.7}, {"hysteresis", 0.2}, {"cycles", 5}});
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json record = Json::parse(answer.body)["record"];
    const Answer model = identify_call(Json{{"record", record}, {"identify", {{"model", "fopdt"}}}}.dump(), {});
    ASSERT_EQ(model.status, 200) << model.body;
    const Json plant = Json::parse(model.body)["model"]["plant"];
    EXPECT_NEAR(plant["K"], 1, 1e-3);
    EXPECT_NEAR(plant["T"], 10, 1e-2);
    EXPECT_NEAR(plant["L"], 2, 2e-3);
}

TEST(RelayCall, EqualSeedsGiveEqualRecordsAndOthersDoNot) {
    Json relay = {{"hysteresis", 0.2}, {"noise_std", 0.02}, {"relay_sample_time", 0.05}, {"cycles", 3}, {"seed", 7}};
    const Answer one = call(kFirstOrder, relay), again = call(kFirstOrder, relay);
    ASSERT_EQ(one.status, 200) << one.body;
    EXPECT_EQ(one.body, again.body);
    relay["seed"] = 8;
    EXPECT_NE(call(kFirstOrder, relay).body, one.body);
}

TEST(RelayCall, TheDefaultsAreASymmetricRelayWithoutHysteresis) {
    const Answer answer = relay_call(Json{{"plant", kFirstOrder}}.dump(), {});
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(Json::parse(answer.body)["record"]["u"][0], 1);
}

struct Refusal {
    const char* name;
    Json plant, relay;
    const char *pointer, *sentence;
};

std::string case_name(const testing::TestParamInfo<Refusal>& given) { return given.param.name; }

class RelayRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(RelayRefuses, WithPlaceAndCure) {
    const Refusal& given = GetParam();
    const Answer answer = call(given.plant, given.relay);
    EXPECT_EQ(answer.status, 422) << answer.body.substr(0, 300);
    const Json problem = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(problem, "Problem"), std::vector<std::string>{});
    ASSERT_TRUE(problem.contains("errors")) << answer.body;
    EXPECT_EQ(problem["errors"][0]["pointer"], given.pointer);
    EXPECT_THAT(problem["errors"][0]["detail"].get<std::string>(), HasSubstr(given.sentence));
}

const Json kIntegrating = {{"type", "ipdt"}, {"K", 1}, {"L", 1}};

INSTANTIATE_TEST_SUITE_P(
    All, RelayRefuses,
    testing::Values(
        Refusal{"NoiseWithoutSamples",
                kFirstOrder,
                {{"noise_std", 0.1}},
                "/relay/relay_sample_time",
                "noise belongs to samples"},
        Refusal{
            "LevelsExchanged", kFirstOrder, {{"u_plus", -1}, {"u_minus", 1}}, "/relay/u_minus", "Swap the two values"},
        Refusal{"TooManyCycles", kFirstOrder, {{"cycles", 1001}}, "/relay/cycles", "1000"},
        Refusal{"IntervalBetweenSamples",
                kFirstOrder,
                {{"relay_sample_time", 0.1}, {"record_interval", 0.25}},
                "/relay/record_interval",
                "a whole multiple of relay_sample_time"},
        Refusal{"TooManyRows",
                kFirstOrder,
                {{"record_interval", 1e-4}},
                "/relay/record_interval",
                "at most 100000 are recorded"},
        Refusal{"HysteresisBeyondTheSwing",
                kFirstOrder,
                {{"hysteresis", 1.5}},
                "/relay/hysteresis",
                "Lower the hysteresis below 0.8"},
        Refusal{"LevelsOfOneSign", kFirstOrder, {{"u_plus", 2}, {"u_minus", 1}}, "/relay/u_minus", "both sides of 0"},
        Refusal{"LevelsOfOneSignOnAnIntegrator",
                kIntegrating,
                {{"u_plus", 2}, {"u_minus", 1}},
                "/relay/u_minus",
                "u_plus must be > 0 and u_minus < 0"},
        Refusal{"InfinitelyFast", Json{{"type", "fopdt"}, {"K", 1}, {"T", 1}, {"L", 0}}, Json::object(),
                "/relay/hysteresis", "switches infinitely fast"},
        Refusal{"UnstableAndSlow", Json{{"type", "fopdt"}, {"K", -1}, {"T", -1}, {"L", 0.7}}, Json::object(),
                "/plant/L", "ln 2"},
        Refusal{"UnknownField", kFirstOrder, {{"hysterese", 1}}, "/relay/hysterese", "did you mean hysteresis"},
        Refusal{"NoPlant", Json{{"type", "fopdt"}, {"K", 0}, {"T", 1}, {"L", 1}}, Json::object(), "/plant/K", "K"}),
    case_name);

}  // namespace
}  // namespace tunewright::api
