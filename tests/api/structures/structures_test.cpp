// POST /v1/cascade, /v1/level, /v1/feedforward, /v1/interaction, /v1/predictor: answers against the document and each
// other, every error with its place.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/services/structure_service.h"
#include "engine/tuning/limits.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::HasSubstr;
using Call = Answer (*)(std::string_view, const RunControl&);

Json cascade() { return {{"inner", {{"plant", "2 e^(-s)/(4s+1)"}}}, {"outer", {{"plant", "1.5 e^(-8s)/(30s+1)"}}}}; }

Json level() { return {{"volume", 12}, {"largest_step", 4}, {"allowed", 1.8}}; }

Json feedforward() {
    return {{"plant", "1.5 e^(-15s)/(60s+1)"},
            {"disturbance", {{"type", "fopdt"}, {"K", 1}, {"T", 15}, {"L", 0}}},
            {"feedback", {{"Kp", 1.3333}, {"Ti", 60}}}};
}

Json interaction() {
    return {{"plant", Json::array({Json::array({"12.8 e^(-s)/(16.7s+1)", "-18.9 e^(-3s)/(21s+1)"}),
                                   Json::array({"6.6 e^(-7s)/(10.9s+1)", "-19.4 e^(-3s)/(14.4s+1)"})})},
            {"controllers", Json::array({Json{{"Kp", 0.375}, {"Ti", 8.29}}, Json{{"Kp", -0.075}, {"Ti", 23.6}}})}};
}

Json predictor() { return {{"plant", "e^(-s)/(s+1)"}, {"Ms", 1.6}}; }

Json with(Json request, const char* pointer, const Json& value) {
    request[Json::json_pointer(pointer)] = value;
    return request;
}

Json answered(Call call, const Json& request, const char* component) {
    const Answer answer = call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << answer.body;
    const Json value = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(value, component), std::vector<std::string>{});
    return value;
}

std::vector<std::string> codes(const Json& answer) {
    std::vector<std::string> out;
    for (const Json& one : answer["verdict"]) out.push_back(one["code"]);
    return out;
}

/// The refusal names the place, and its sentence has the words.
void expect_refusal(Call call, const Json& request, const std::string& pointer, const std::string& words) {
    SCOPED_TRACE(request.dump());
    const Answer answer = call(request.dump(), {});
    EXPECT_EQ(answer.status, 422) << answer.body;
    const Json problem = Json::parse(answer.body);
    ASSERT_TRUE(problem.contains("errors")) << answer.body;
    for (const Json& error : problem["errors"])
        if (error["pointer"] == pointer) {
            EXPECT_THAT(error["detail"].get<std::string>(), HasSubstr(words));
            return;
        }
    ADD_FAILURE() << "no error at " << pointer << ": " << answer.body;
}

TEST(CascadeCall, ADesignHoldsItsLimitsAndSaysWhatItGains) {
    const Json a = answered(cascade_call, cascade(), "CascadeAnswer");
    EXPECT_LE(a["inner"]["robustness"]["Ms"].get<double>(), limits::kDefaultMs * (1 + 1e-5));
    EXPECT_LE(a["outer"]["robustness"]["Ms"].get<double>(), limits::kDefaultMs * (1 + 1e-5));
    EXPECT_NEAR(a["Ms_valve_limit"].get<double>(), 1.15 * limits::kDefaultMs, 1e-12);
    EXPECT_LE(a["outer"]["robustness"]["Ms_valve"].get<double>(), a["Ms_valve_limit"].get<double>() * (1 + 1e-5));
    const Json& outer = a["outer"]["controller"];
    EXPECT_NEAR(a["performance"]["outer_load"]["IE"].get<double>(),
                -outer["Ti"].get<double>() / outer["Kp"].get<double>(), 1e-5);
    EXPECT_DOUBLE_EQ(a["gain"]["inner_load"].get<double>(),
                     a["single"]["performance"]["inner_load"]["IAE"].get<double>() /
                         a["performance"]["inner_load"]["IAE"].get<double>());
    EXPECT_THAT(codes(a), Contains("cascade-pays"));
}

TEST(CascadeCall, GivenControllersAreOnlyJudged) {
    Json request = with(with(cascade(), "/inner/controller", {{"Kp", 0.6}, {"Ti", 3}}), "/outer/controller",
                        {{"form", "parallel"}, {"Kp", 1.5}, {"Ki", 0.08}});
    request["compare_single"] = false;
    const Json a = answered(cascade_call, request, "CascadeAnswer");
    EXPECT_EQ(a["inner"]["controller"]["Kp"], 0.6);
    EXPECT_NEAR(a["outer"]["controller"]["Ti"].get<double>(), 1.5 / 0.08, 1e-12);
    EXPECT_TRUE(a["single"].is_null());
    EXPECT_EQ(a["why_null"]["single"], "compare_single is false.");
    EXPECT_THAT(codes(a), Contains("outer-peak-above"));
}

TEST(CascadeCall, UnstableLoopsHaveNoFiguresAndTheirReason) {
    const Json request = with(with(cascade(), "/inner/controller", {{"Kp", 0.6}, {"Ti", 3}}), "/outer/controller",
                              {{"Kp", 40}, {"Ti", 3}});
    const Json a = answered(cascade_call, request, "CascadeAnswer");
    EXPECT_TRUE(a["outer"]["robustness"]["Ms_valve"].is_null());
    EXPECT_EQ(a["outer"]["robustness"]["why_null"]["Ms_valve"], "The loops are not stable.");
    EXPECT_TRUE(a["performance"]["inner_load"]["IAE"].is_null());
    EXPECT_THAT(codes(a), testing::ElementsAre("unstable"));
}

TEST(CascadeCall, AnInnerLoopThatIsSlowerSaysSo) {
    const Json request{{"inner", {{"plant", "e^(-20s)/(60s+1)"}}}, {"outer", {{"plant", "e^(-2s)/(5s+1)"}}}};
    const Json a = answered(cascade_call, request, "CascadeAnswer");
    EXPECT_LT(a["speed_ratio"].get<double>(), 3);
    EXPECT_THAT(codes(a), Contains("inner-too-slow"));
}

TEST(CascadeCall, TheBaselineIsJudgedBesideTheDesign) {
    const Json request =
        with(cascade(), "/baseline", {{"inner", {{"Kp", 0.3}, {"Ti", 4}}}, {"outer", {{"Kp", 0.5}, {"Ti", 30}}}});
    const Json a = answered(cascade_call, request, "CascadeAnswer");
    EXPECT_TRUE(a["baseline"]["stable"]);
    EXPECT_NEAR(a["baseline"]["performance"]["outer_load"]["IE"].get<double>(), -60, 1e-5);
}

TEST(CascadeCall, ErrorsNameThePlaceAndTheCure) {
    expect_refusal(cascade_call, Json::object(), "/inner/plant", "plant is missing");
    expect_refusal(cascade_call, with(cascade(), "/inner/plant", {{"type", "fopdt"}, {"K", 0}, {"T", 1}, {"L", 1}}),
                   "/inner/plant/K", "K is 0");
    expect_refusal(cascade_call, with(cascade(), "/outer/plant", "2 e^(-3s)/(10s+"), "/outer/plant", "");
    expect_refusal(cascade_call, with(cascade(), "/inner/tune", {{"method", "simc"}}), "/inner/tune/method",
                   "only robust");
    expect_refusal(cascade_call, with(cascade(), "/inner/tune", {{"Ms", 1}}), "/inner/tune/Ms", "Ms is 1");
    expect_refusal(cascade_call,
                   with(with(cascade(), "/inner/tune", Json::object()), "/inner/controller", {{"Kp", 1}, {"Ti", 3}}),
                   "/inner/controller", "Remove one.");
    expect_refusal(cascade_call,
                   with(cascade(), "/inner/controller", {{"form", "npid"}, {"Kp", 1}, {"Ti", 3}, {"delta_r", 1}}),
                   "/inner/controller/form", "only linear forms");
    expect_refusal(cascade_call, with(cascade(), "/weights", {{"d1", 2}}), "/weights", "set search to joint");
    expect_refusal(cascade_call, with(with(cascade(), "/search", "joint"), "/inner/controller", {{"Kp", 1}, {"Ti", 3}}),
                   "/search", "take search sequential");
    expect_refusal(cascade_call, with(with(cascade(), "/search", "joint"), "/weights", {{"d1", 0}, {"d2", 0}}),
                   "/weights", "one of them must be above 0");
    expect_refusal(cascade_call, with(cascade(), "/inner/controller", {{"Kp", 40}, {"Ti", 3}}), "/inner/controller",
                   "not stable");
    expect_refusal(cascade_call,
                   with(with(cascade(), "/inner/controller", {{"Kp", 0.5}, {"Ti", 4}}), "/outer/controller",
                        {{"Kp", 1}, {"Ti", 30}, {"Td", 2}}),
                   "/outer/controller", "filter");
    expect_refusal(cascade_call,
                   with(cascade(), "/outer/plant",
                        {{"type", "fopdt"}, {"K", 1}, {"T", 9}, {"L", 1}, {"uncertainty", {{"K", {0.8, 1.2}}}}}),
                   "/outer/plant/uncertainty", "nominal plant");
    expect_refusal(cascade_call, with(cascade(), "/inner/plnt", 1), "/inner/plnt", "did you mean plant?");
}

TEST(LevelCall, TheDesignUsesTheRoomAndTheFrontierEndsWithProportionalActionAlone) {
    const Json a = answered(level_call, level(), "LevelAnswer");
    EXPECT_NEAR(a["design"]["highest"].get<double>(), 1.8, 1e-9);
    EXPECT_NEAR(a["bound"].get<double>(), 16 / (2 * 12 * 1.8), 1e-12);
    EXPECT_NEAR(a["design"]["rate_over_bound"].get<double>(), 2 * 0.520637769857, 1e-6);
    EXPECT_TRUE(a["robustness"]["Ms"].is_null());
    EXPECT_EQ(a["robustness"]["why_null"]["Ms"], "The flow loop is not given.");
    EXPECT_TRUE(a["frontier"].back()["Ti"].is_null());
    EXPECT_EQ(a["frontier"].back()["overshoot_percent"], 0);
    EXPECT_THAT(codes(a), testing::ElementsAre("near-lowest-rate"));
}

TEST(LevelCall, ASlowFlowLoopAndABrokenRoomAreConclusions) {
    Json request = with(level(), "/flow_loop", {{"T", 60}, {"L", 0.5}});
    EXPECT_THAT(codes(answered(level_call, request, "LevelAnswer")), Contains("flow-loop-unstable"));
    request["flow_loop"]["T"] = 0.7;
    EXPECT_THAT(codes(answered(level_call, request, "LevelAnswer")), Contains("flow-loop-too-slow"));
    const Json judged = answered(level_call, with(level(), "/controller", {{"Kc", 1}}), "LevelAnswer");
    EXPECT_EQ(judged["design"]["highest"], 4);
    EXPECT_THAT(codes(judged), Contains("level-above-room"));
}

TEST(LevelCall, ErrorsNameThePlaceAndTheCure) {
    expect_refusal(level_call, Json::object(), "/volume", "volume is missing");
    expect_refusal(level_call, with(level(), "/allowed", 0), "/allowed", "allowed is 0");
    expect_refusal(level_call, with(level(), "/zeta", 0.7), "/zeta", "Set aim to zeta");
    expect_refusal(level_call, with(level(), "/aim", "zeta"), "/zeta", "zeta is missing");
    expect_refusal(level_call, with(level(), "/aim", "slow"), "/aim", "aim is");
    expect_refusal(level_call, with(level(), "/gap", 0.5), "/gap", "no_outflow_overshoot");
    expect_refusal(level_call, with(with(level(), "/gap", 2), "/aim", "no_outflow_overshoot"), "/gap", "gap is 2");
    expect_refusal(level_call, with(level(), "/flow_loop", {{"T", -1}}), "/flow_loop/T", "T is -1");
    expect_refusal(level_call, with(level(), "/controller", {{"Ti", 3}}), "/controller/Kc", "Kc is missing");
    expect_refusal(level_call, with(with(level(), "/aim", "rate"), "/controller", {{"Kc", 3}}), "/aim",
                   "Remove one of them");
}

TEST(FeedforwardCall, TheVariantsShareThePeakThatNoneAvoids) {
    const Json a = answered(feedforward_call, with(feedforward(), "/feedforward", {{"jump", 12}}), "FeedforwardAnswer");
    EXPECT_NEAR(a["peak_bound"].get<double>(), 1 - std::exp(-1.0), 1e-6);
    EXPECT_EQ(a["late"], 15);
    std::vector<std::string> kinds;
    for (const Json& one : a["variants"]) kinds.push_back(one["kind"]);
    EXPECT_THAT(kinds, testing::ElementsAre("none", "static", "inverse", "guzman_hagglund", "optimum"));
    EXPECT_NEAR(a["variants"][4]["u_start"].get<double>(), -12, 1e-9);
    EXPECT_THAT(codes(a),
                testing::IsSupersetOf({"feedforward-pays", "gain-alone-worse-than-none", "peak-unavoidable"}));
}

TEST(FeedforwardCall, AnInverseBeyondTheJumpIsLeftOutWithItsReason) {
    const Json a = answered(feedforward_call, with(feedforward(), "/feedforward", {{"jump", 2}}), "FeedforwardAnswer");
    EXPECT_TRUE(a["variants"][2]["compensator"].is_null());
    EXPECT_TRUE(a["variants"][2]["IAE"].is_null());
    EXPECT_THAT(a["variants"][2]["why_not"].get<std::string>(), HasSubstr("first move"));
}

TEST(FeedforwardCall, AnExactInverseAGivenCompensatorAndADesignedFeedback) {
    Json request = with(feedforward(), "/disturbance/L", 20);
    request["feedback"] = {{"tune", {{"controller", "PI"}}}};
    const Json exact = answered(feedforward_call, request, "FeedforwardAnswer");
    EXPECT_GT(exact["feedback"]["Kp"].get<double>(), 0);
    EXPECT_THAT(codes(exact), Contains("feedforward-exact"));
    const Json given = answered(
        feedforward_call, with(feedforward(), "/controller", {{"Kf", 2}, {"Tz", 60}, {"Tp", 15}}), "FeedforwardAnswer");
    ASSERT_EQ(given["variants"].size(), 2u);
    EXPECT_EQ(given["variants"][1]["kind"], "given");
    EXPECT_THAT(codes(given), Contains("feedforward-worse-than-none"));
}

TEST(FeedforwardCall, ErrorsNameThePlaceAndTheCure) {
    expect_refusal(feedforward_call, {{"feedback", {{"Kp", 1}, {"Ti", 60}}}}, "/disturbance", "disturbance is missing");
    expect_refusal(feedforward_call, with(feedforward(), "/feedback", {{"Kp", 90}, {"Ti", 60}}), "/feedback",
                   "not stable");
    expect_refusal(feedforward_call, with(feedforward(), "/feedback/tune", Json::object()), "/feedback/tune",
                   "stands alone");
    expect_refusal(feedforward_call, with(feedforward(), "/feedback", 3), "/feedback", "must be an object");
    expect_refusal(feedforward_call, with(feedforward(), "/disturbance", "1/s"), "/disturbance", "integrators");
    expect_refusal(feedforward_call, with(feedforward(), "/feedforward", {{"jump", 0}}), "/feedforward/jump",
                   "jump is 0");
    expect_refusal(feedforward_call, with(feedforward(), "/controller", {{"Kf", 1}, {"Tz", 3}}), "/controller/Tp",
                   "Give a lag");
    expect_refusal(feedforward_call, with(feedforward(), "/uncertainty", 1), "/uncertainty", "uncertainty is 1");
}

TEST(InteractionCall, GivenControllersAreJudgedWithGainsAndPairings) {
    const Json a = answered(interaction_call, interaction(), "InteractionAnswer");
    EXPECT_NEAR(a["rga"][0][0].get<double>(), 2.009386632, 1e-8);
    EXPECT_NEAR(a["pairings"][0]["niederlinski"].get<double>(), 0.497664304, 1e-8);
    EXPECT_EQ(a["pairing"], Json::array({1, 2}));
    EXPECT_NEAR(a["Lcm_dB"].get<double>(), 3.97569106, 1e-4);
    EXPECT_EQ(a["manual"]["may_open"], Json::array({true, true}));
    EXPECT_TRUE(a["F_blt"].is_null());
    EXPECT_THAT(codes(a), testing::ElementsAre("mu-above"));
}

TEST(InteractionCall, AGivenPairingAndPathsThatAreNotThere) {
    Json request = interaction();
    request["pairing"] = {2, 1};
    EXPECT_THAT(codes(answered(interaction_call, request, "InteractionAnswer")),
                testing::IsSupersetOf({"pairing-impossible", "other-pairing-better", "unstable"}));
    request = {{"plant", Json::array({Json::array({"e^(-s)/(5s+1)", 0}), Json::array({nullptr, "2 e^(-2s)/(9s+1)"})})},
               {"compare", {"blt"}},
               {"limit", {{"mu", 1.6}}}};
    const Json a = answered(interaction_call, request, "InteractionAnswer");
    EXPECT_NEAR(a["mu"].get<double>(), std::max(a["Ms_alone"][0].get<double>(), a["Ms_alone"][1].get<double>()), 1e-4);
    EXPECT_EQ(a["rga"], Json::array({Json::array({1, 0}), Json::array({0, 1})}));
    EXPECT_LE(a["mu"].get<double>(), 1.6 * (1 + 1e-5));
    EXPECT_THAT(codes(a), Contains("hardly-interacting"));
    ASSERT_EQ(a["compared"].size(), 1u);
    EXPECT_EQ(a["compared"][0]["name"], "blt");
}

TEST(InteractionCall, DecouplersStandNextToTheLoopsWithoutOne) {
    Json request{{"plant", Json::array({Json::array({"22.89 e^(-0.2s)/(4.572s+1)", "-11.64 e^(-0.4s)/(1.807s+1)"}),
                                        Json::array({"4.689 e^(-0.2s)/(2.174s+1)", "5.8 e^(-0.4s)/(1.801s+1)"})})},
                 {"decoupler", "simplified"},
                 {"compare", {"blt", "static_decoupler"}},
                 {"sampled", Json::object()}};
    const Json a = answered(interaction_call, request, "InteractionAnswer");
    EXPECT_THAT(codes(a), Contains("decoupler-helps"));
    const Json& own = a["decoupling"];
    EXPECT_EQ(own["kind"], "simplified");
    EXPECT_NEAR(own["D"][0][1]["Kf"].get<double>(), 11.64 / 22.89, 1e-9);
    EXPECT_NEAR(own["D"][0][1]["Lf"].get<double>(), 0.2, 1e-9);
    EXPECT_NEAR(own["D"][1][0]["Tz"].get<double>(), 1.801, 1e-9);
    EXPECT_TRUE(own["D"][0][0].is_null());
    EXPECT_NEAR(own["unrealised"][1][0].get<double>(), 0.2, 1e-9);
    EXPECT_TRUE(own["wrong_gains"]["stable"]);
    EXPECT_GT(own["wrong_gains"]["mu"], a["mu"]);
    ASSERT_EQ(a["compared"].size(), 3u);
    const Json &without = a["compared"][0], &luyben = a["compared"][1], &fixed = a["compared"][2];
    EXPECT_EQ(without["name"], "no_decoupler");
    EXPECT_TRUE(without["decoupling"].is_null() || !without.contains("decoupling"));
    EXPECT_NEAR(own["gain"].get<double>(), without["cost"].get<double>() / a["cost"].get<double>(), 1e-9);
    EXPECT_EQ(luyben["name"], "blt");
    EXPECT_EQ(fixed["name"], "static_decoupler");
    EXPECT_NEAR(fixed["decoupling"]["gain"].get<double>(), without["cost"].get<double>() / fixed["cost"].get<double>(),
                1e-9);
    // The program decouples: a step of r2 hardly moves y1, whose element needs no advance.
    for (const Json& response : a["sampled"]["responses"])
        if (response["input"] == "setpoint_2") {
            EXPECT_LT(response["figures"][0]["IAE"], 0.1 * without["IAE_setpoint"][1][0].get<double>());
        }
}

TEST(InteractionCall, ADecouplerThatCannotRunIsRefusedAndInAComparisonExplained) {
    Json request = interaction();
    request.erase("controllers");
    request["plant"][0][0] = "12.8 (1 - 30s) e^(-s)/((16.7s+1)(5s+1))";
    request["pairing"] = {1, 2};
    expect_refusal(interaction_call, with(request, "/decoupler", "simplified"), "/decoupler", "right half-plane");
    expect_refusal(interaction_call, with(request, "/decoupler", "dynamic"), "/decoupler", "decoupler is");
    Json given = with(interaction(), "/compare", {"static_decoupler"});
    const Json a = answered(interaction_call, given, "InteractionAnswer");
    EXPECT_EQ(a["compared"][0]["why_not"], "Nothing was designed.");
    const Json judged = answered(interaction_call, with(interaction(), "/decoupler", "static"), "InteractionAnswer");
    EXPECT_EQ(judged["decoupling"]["kind"], "static");
    EXPECT_TRUE(judged["decoupling"]["gain"].is_null());
    EXPECT_EQ(judged["decoupling"]["why_null"]["gain"], "Nothing was designed.");
}

TEST(InteractionCall, ErrorsNameThePlaceAndTheCure) {
    expect_refusal(interaction_call, Json::object(), "/plant", "Give either plant");
    expect_refusal(interaction_call, with(interaction(), "/plant", "1/(s+1)"), "/plant", "two or three rows");
    expect_refusal(interaction_call, with(interaction(), "/plant/1", Json::array({"1/(s+1)"})), "/plant/1",
                   "write 0 for a path");
    expect_refusal(interaction_call, with(interaction(), "/plant/0/1", "1/("), "/plant/0/1", "");
    expect_refusal(interaction_call, with(interaction(), "/pairing", {1, 1}), "/pairing", "each input once");
    expect_refusal(interaction_call, with(interaction(), "/pairing", {1, 2, 3}), "/pairing", "one for each output");
    expect_refusal(interaction_call, with(interaction(), "/controllers", "PD"), "/controllers", "controllers is");
    expect_refusal(interaction_call, with(interaction(), "/controllers/1/Kp", 0), "/controllers/1/Kp", "Kp is 0");
    expect_refusal(interaction_call, with(interaction(), "/limit", {{"mu", 1}}), "/limit/mu", "mu is 1");
    expect_refusal(interaction_call, with(interaction(), "/weights", {{"y", {1, 1, 1}}}), "/weights/y",
                   "one for each output");
    expect_refusal(interaction_call, with(interaction(), "/compare", {"zn"}), "/compare/0", "compare");
    expect_refusal(interaction_call,
                   {{"plant", Json::array({Json::array({"1/(s+1)", "2/(s+1)"}), Json::array({"1/(s+1)", "2/(s+1)"})})}},
                   "/plant", "singular");
    expect_refusal(interaction_call, with(with(interaction(), "/plant/0/0", 0), "/pairing", {1, 2}), "/pairing",
                   "does not move it");
}

TEST(PredictorCall, TheAnswerSaysThatThePidDoesAsWell) {
    const Json a = answered(predictor_call, predictor(), "PredictorAnswer");
    EXPECT_NEAR(a["lambda"].get<double>(), 0.6637, 1e-4);
    EXPECT_NEAR(a["load"]["IE"].get<double>(), -(1 + a["lambda"].get<double>()), 1e-5);
    EXPECT_LT(a["pid_IAE"].get<double>(), a["load"]["IAE"].get<double>());
    EXPECT_THAT(codes(a), Contains("pid-does-as-well"));
    EXPECT_FALSE(a.contains("Tf"));
}

TEST(PredictorCall, AWindowAWrongModelAndAGivenController) {
    Json request = with(with(predictor(), "/Ms", 1.95), "/dead_time_error", 0.4);
    const Json windowed = answered(predictor_call, request, "PredictorAnswer");
    EXPECT_GE(windowed["robustness"]["dead_time_up"].get<double>(), 0.4 - 1e-4);
    EXPECT_THAT(codes(windowed), Contains("limited-by-dead-time-error"));

    request = with(predictor(), "/model", "e^(-2s)/(s+1)");
    request["plant"] = "e^(-s)/((s+1)(0.3s+1))";
    EXPECT_TRUE(answered(predictor_call, request, "PredictorAnswer")["robustness"]["stable"]);

    const Json C{{"num", {1.8, 4}}, {"den", {1, 0}}}, F{{"num", {1}}, {"den", {1}}};
    request = {{"plant", "e^(-8s)/(s+1)"}, {"controller", {{"C", C}, {"F", F}}}};
    const Json given = answered(predictor_call, request, "PredictorAnswer");
    EXPECT_FALSE(given["robustness"]["controller_stable"]);
    EXPECT_THAT(codes(given), testing::IsSupersetOf({"controller-unstable", "narrow-dead-time-window"}));
    EXPECT_EQ(given["why_null"]["pid"], "A given controller is not compared.");
}

TEST(PredictorCall, OnAnUnstablePlantTheResponsesAreUnknownWithTheReason) {
    const Json a = answered(
        predictor_call,
        {{"plant", {{"type", "fopdt"}, {"K", -1}, {"T", -4}, {"L", 0.5}}}, {"kind", "filtered_smith"}, {"Ms", 1.9}},
        "PredictorAnswer");
    EXPECT_TRUE(a["robustness"]["stable"]);
    EXPECT_TRUE(a["load"]["IAE"].is_null());
    EXPECT_THAT(a["load"]["why_null"]["IAE"].get<std::string>(), HasSubstr("unstable model"));
}

TEST(PredictorCall, ErrorsNameThePlaceAndTheCure) {
    expect_refusal(predictor_call, Json::object(), "/plant", "plant is missing");
    expect_refusal(predictor_call, {{"plant", "e^(-s)/((s+1)(2s+1))"}}, "/plant", "as model");
    expect_refusal(predictor_call, with(predictor(), "/model", "e^(-s)/((s+1)(2s+1))"), "/model", "first order");
    expect_refusal(predictor_call, {{"plant", "1/(s+1)"}}, "/plant", "no dead time");
    expect_refusal(predictor_call, with(predictor(), "/Ms", 2), "/Ms", "Ms is 2");
    expect_refusal(predictor_call, with(predictor(), "/kind", "smth"), "/kind", "kind is");
    expect_refusal(predictor_call, with(predictor(), "/dead_time_error", 0), "/dead_time_error",
                   "dead_time_error is 0");
    expect_refusal(predictor_call, {{"plant", "e^(-s)/s"}}, "/kind", "filtered_smith");
    const Json part{{"num", {1}}, {"den", {1}}}, improper{{"num", {1, 1}}, {"den", {1}}},
        two{{"num", {2}}, {"den", {1}}};
    expect_refusal(predictor_call, with(predictor(), "/controller", {{"C", improper}, {"F", part}}),
                   "/controller/C/num", "cannot be built");
    expect_refusal(predictor_call, with(predictor(), "/controller", {{"C", part}, {"F", two}}), "/controller/F",
                   "F(0) is not 1");
    expect_refusal(predictor_call, with(with(predictor(), "/controller", {{"C", part}, {"F", part}}), "/kind", "smith"),
                   "/kind", "Remove one of them");
}

TEST(StructureCalls, AStoppedCallSaysSoAndOneThatIsNotJsonToo) {
    std::stop_source stopped;
    stopped.request_stop();
    RunControl control;
    control.stop = stopped.get_token();
    Json designed = interaction();
    designed.erase("controllers");
    for (const auto& [call, request] : {std::pair<Call, Json>{cascade_call, cascade()},
                                        {feedforward_call, feedforward()},
                                        {interaction_call, designed},
                                        {predictor_call, predictor()}}) {
        const Answer answer = call(request.dump(), control);
        EXPECT_GE(answer.status, 400) << answer.body;
        EXPECT_NE(answer.status, 422) << answer.body;
    }
    for (const Call call : {cascade_call, level_call, feedforward_call, interaction_call, predictor_call})
        EXPECT_EQ(call("{", {}).status, 400);
}

}  // namespace
}  // namespace tunewright::api
