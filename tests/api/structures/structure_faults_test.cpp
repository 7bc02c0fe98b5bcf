// What holds for every answer and every error of the calls about structures: a null has a reason, and an error is at
// the member that was changed.
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "api/services/structure_service.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

struct AskedStructure {
    std::string name;
    Answer (*call)(std::string_view, const RunControl&);
    Json request;
    std::vector<std::string> members;  ///< pointers of members that do not take the values of kBadValues
};

Json changed(Json request, const std::string& pointer, const Json& value) {
    request[Json::json_pointer(pointer)] = value;
    return request;
}

const std::vector<std::string> kCommon = {"/evaluate",         "/evaluate/points", "/implement",
                                          "/implement/y_span", "/sampled",         "/sampled/sample_time",
                                          "/sampled/u_max",    "/units",           "/timeout_s"};

std::vector<AskedStructure> asked_structures() {
    const Json pi{{"Kp", 0.375}, {"Ti", 8.29}};
    std::vector<AskedStructure> out{
        {"cascade",
         cascade_call,
         {{"inner", {{"plant", "2 e^(-s)/(4s+1)"}}}, {"outer", {{"plant", "1.5 e^(-8s)/(30s+1)"}}}},
         {"/inner",
          "/inner/plant",
          "/inner/record",
          "/inner/tune",
          "/inner/tune/controller",
          "/inner/tune/Ms",
          "/inner/tune/Mt",
          "/inner/controller",
          "/outer",
          "/outer/plant",
          "/outer/record",
          "/outer/tune",
          "/outer/tune/Ms",
          "/outer/controller",
          "/record",
          "/arrangement",
          "/limits",
          "/limits/Ms_valve",
          "/search",
          "/weights",
          "/weights/d1",
          "/baseline",
          "/compare_single"}},
        {"level",
         level_call,
         {{"volume", 12}, {"largest_step", 4}, {"allowed", 1.8}},
         {"/volume", "/largest_step", "/allowed", "/aim", "/zeta", "/gap", "/flow_loop", "/flow_loop/T", "/flow_loop/L",
          "/controller", "/controller/Kc"}},
        {"feedforward",
         feedforward_call,
         {{"plant", "1.5 e^(-15s)/(60s+1)"}, {"disturbance", "1/(15s+1)"}, {"feedback", {{"Kp", 1.3333}, {"Ti", 60}}}},
         {"/plant", "/disturbance", "/record", "/feedback", "/feedback/Kp", "/feedback/Ti", "/feedforward",
          "/feedforward/jump", "/feedforward/method", "/feedforward/form", "/controller", "/controller/Kf",
          "/uncertainty"}},
        {"interaction",
         interaction_call,
         {{"plant", Json::array({Json::array({"12.8 e^(-s)/(16.7s+1)", "-18.9 e^(-3s)/(21s+1)"}),
                                 Json::array({"6.6 e^(-7s)/(10.9s+1)", "-19.4 e^(-3s)/(14.4s+1)"})})},
          {"controllers", Json::array({pi, Json{{"Kp", -0.075}, {"Ti", 23.6}}})}},
         {"/plant", "/plant/0", "/plant/1/0", "/records", "/pairing", "/pairing/0", "/controllers", "/controllers/1",
          "/controllers/1/Kp", "/limit", "/limit/mu", "/weights", "/weights/y", "/baseline", "/compare"}},
        {"predictor",
         predictor_call,
         {{"plant", "2 e^(-4s)/(5s+1)"}},
         {"/plant", "/model", "/kind", "/Ms", "/dead_time_error", "/controller"}}};
    for (AskedStructure& one : out) one.members.insert(one.members.end(), kCommon.begin(), kCommon.end());
    return out;
}

TEST(StructureFaults, AnErrorIsAtTheMemberThatHasTheBadValue) {
    for (const AskedStructure& one : asked_structures())
        for (const std::string& member : one.members)
            for (const Json& bad : {Json("1/(s+"), Json{{"nonsense", 1}}, Json::array({Json::array()})}) {
                if (member.ends_with("/sampled") && bad.is_object()) continue;  // a run needs the sample time
                const Answer answer = one.call(changed(one.request, member, bad).dump(), {});
                SCOPED_TRACE(one.name + member + " " + bad.dump() + " " + answer.body);
                ASSERT_EQ(answer.status, 422);
                const Json problem = Json::parse(answer.body);
                ASSERT_TRUE(problem.contains("errors"));
                for (const Json& error : problem["errors"]) {
                    const auto pointer = error["pointer"].get<std::string>();
                    const bool whole = member.starts_with(pointer) && problem["errors"].size() == 1;
                    EXPECT_TRUE(pointer == member || pointer.starts_with(member + "/") || whole) << pointer;
                }
            }
}

/// The one error of a request whose members are each valid.
void expect_fault(const AskedStructure& one, const Json& request, const std::string& pointer,
                  const std::string& words) {
    SCOPED_TRACE(request.dump());
    const Answer answer = one.call(request.dump(), {});
    ASSERT_EQ(answer.status, 422) << answer.body;
    const Json problem = Json::parse(answer.body);
    ASSERT_EQ(problem["errors"].size(), 1u) << answer.body;
    EXPECT_EQ(problem["errors"][0]["pointer"], pointer) << answer.body;
    EXPECT_THAT(problem["errors"][0]["detail"].get<std::string>(), HasSubstr(words));
}

TEST(StructureFaults, WhatTheDesignRefusesIsAtItsCause) {
    const auto all = asked_structures();
    const AskedStructure &cascade = all[0], &feedforward = all[2], &interaction = all[3], &predictor = all[4];
    expect_fault(cascade, changed(cascade.request, "/inner/plant", "1/(s+1)"), "/inner/plant", "no dead time");
    expect_fault(cascade, changed(cascade.request, "/inner/plant", "s/(s+1)"), "/inner/plant", "zero at s = 0");
    expect_fault(
        cascade,
        changed(changed(cascade.request, "/inner/plant", "1/(s+1)"), "/outer/controller", {{"Kp", 1}, {"Ti", 9}}),
        "/inner/plant", "no dead time");
    const Json tuned = changed(feedforward.request, "/feedback", {{"tune", {{"controller", "PI"}}}});
    expect_fault(feedforward, changed(tuned, "/plant", "1/(s+1)"), "/plant", "no dead time");
    expect_fault(feedforward,
                 changed(changed(feedforward.request, "/controller", {{"Kf", 1}}), "/feedforward", {{"jump", 2}}),
                 "/feedforward", "Remove one of them");
    expect_fault(interaction, changed(interaction.request, "/compare", {"blt", "blt"}), "/compare", "twice");
    expect_fault(predictor, changed(predictor.request, "/Ms", 1.995), "/Ms", "1.99");
    const Json part{{"num", {1}}, {"den", {1}}};
    expect_fault(predictor, changed(changed(predictor.request, "/controller", {{"C", part}, {"F", part}}), "/Ms", 1.5),
                 "/Ms", "Remove one of them");
}

TEST(StructureFaults, APairingThatNoDesignCanHoldIsRefusedAsSuch) {
    const AskedStructure interaction = asked_structures()[3];
    Json request = interaction.request;
    request.erase("controllers");
    expect_fault(interaction, changed(request, "/pairing", {2, 1}), "/pairing", "Niederlinski index is -0.991");
    request["plant"] = Json::array({Json::array({"e^(-s)/(s+1)", "2 e^(-s)/(s+1)", "3 e^(-s)/(s+1)"}),
                                    Json::array({"2 e^(-s)/(s+1)", "e^(-s)/(s+1)", "e^(-s)/(s+1)"}),
                                    Json::array({"3 e^(-s)/(s+1)", "e^(-s)/(s+1)", "3 e^(-s)/(s+1)"})});
    const Json judged =
        Json::parse(interaction_call(changed(request, "/controllers",
                                             Json::array({Json{{"Kp", 0.01}, {"Ti", 9}}, Json{{"Kp", 0.01}, {"Ti", 9}},
                                                          Json{{"Kp", 0.01}, {"Ti", 9}}}))
                                         .dump(),
                                     {})
                        .body);
    for (const Json& pairing : judged["pairings"])
        if (!pairing["possible"].get<bool>())
            expect_fault(interaction, changed(request, "/pairing", pairing["inputs"]), "/pairing", "Choose another");
}

/// Members that are null, or have a null within, without a reason next to them.
std::vector<std::string> unexplained(const Json& value, const std::string& at = "") {
    std::vector<std::string> out;
    const auto add = [&](const std::vector<std::string>& more) { out.insert(out.end(), more.begin(), more.end()); };
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_null()) out.push_back(at);
            add(unexplained(value[i], at + "/" + std::to_string(i)));
        }
    if (!value.is_object()) return out;
    for (const auto& [name, member] : value.items()) {
        const auto reason = value.value("why_null", Json::object()).value(name, "");
        const std::vector<std::string> within = unexplained(member, at + "/" + name);
        const bool listed = member.is_array() && !member.empty() && !member[0].is_object();
        const bool setting = name == "Ti" && value.contains("Kp");  // null: no integral action
        if (reason.empty() && member.is_null() && !setting) out.push_back(at + "/" + name);
        if (reason.empty() || !listed) add(within);
    }
    return out;
}

Json answer_to(const AskedStructure& one, const Json& request) {
    const Answer answer = one.call(request.dump(), {});
    EXPECT_EQ(answer.status, 200) << request.dump() << answer.body.substr(0, 400);
    Json value = Json::parse(answer.body);
    const std::string component = char(std::toupper(one.name[0])) + one.name.substr(1) + "Answer";
    EXPECT_EQ(schema_faults(value, component), std::vector<std::string>{}) << request.dump();
    return value;
}

TEST(StructureFaults, EveryNullHasAReason) {
    EXPECT_THAT(unexplained({{"a", nullptr}, {"b", {1, nullptr}}, {"c", {{"d", nullptr}}}, {"why_null", {{"a", "x"}}}}),
                testing::UnorderedElementsAre("/b", "/c/d"));
    const auto all = asked_structures();
    const Json p{{"Kp", 0.4}}, fast{{"Kp", 60}, {"Ti", 3}}, slow{{"Kp", 0.05}, {"Ti", 30}};
    const auto cascade = [&](const Json& inner, const Json& outer) {
        return changed(changed(all[0].request, "/inner/controller", inner), "/outer/controller", outer);
    };
    const Json gain{{"num", {0.2}}, {"den", {1}}}, sharp{{"num", {9, 9}}, {"den", {1, 0}}},
        one{{"num", {1}}, {"den", {1}}};
    const std::vector<std::pair<std::size_t, Json>> requests{
        {0, all[0].request},
        {0, changed(all[0].request, "/compare_single", false)},
        {0, cascade(p, p)},
        {0, cascade(fast, slow)},
        {0, cascade(slow, fast)},
        {0, changed(all[0].request, "/baseline", {{"inner", fast}, {"outer", p}})},
        {0, changed(cascade(p, p), "/sampled", {{"sample_time", 0.5}})},
        {1, all[1].request},
        {1, changed(all[1].request, "/flow_loop", {{"T", 90}})},
        {1, changed(changed(all[1].request, "/aim", "no_outflow_overshoot"), "/gap", 0.5)},
        {1, changed(changed(all[1].request, "/controller", {{"Kc", 3}}), "/sampled", {{"sample_time", 0.2}})},
        {2, all[2].request},
        {2, changed(all[2].request, "/feedforward", {{"jump", 0.5}})},
        {2, changed(all[2].request, "/feedback", p)},
        {2, changed(changed(all[2].request, "/feedback", {{"Kp", 3.5}, {"Ti", 60}}), "/uncertainty", 0.9)},
        {2, changed(changed(all[2].request, "/feedback", p), "/controller", {{"Kf", 0.3}})},
        {3, all[3].request},
        {3, changed(all[3].request, "/pairing", {2, 1})},
        {3, changed(all[3].request, "/controllers", Json::array({p, Json{{"Kp", -0.1}}}))},
        {3, changed(all[3].request, "/baseline", Json::array({fast, fast}))},
        {3, changed(all[3].request, "/plant/0/1", 0)},
        {4, all[4].request},
        {4, changed(all[4].request, "/plant", {{"type", "fopdt"}, {"K", -1}, {"T", -4}, {"L", 0.5}})},
        {4, changed(all[4].request, "/controller", {{"C", gain}, {"F", one}})},
        {4, changed(all[4].request, "/controller", {{"C", sharp}, {"F", one}})}};
    for (auto [at, request] : requests) {
        if (at == 4 && request["plant"].is_object()) request["kind"] = "filtered_smith", request["Ms"] = 1.9;
        const Json answer = answer_to(all[at], request);
        EXPECT_EQ(unexplained(answer), std::vector<std::string>{}) << request.dump();
        EXPECT_FALSE(answer.value("version", "").empty());
    }
}

TEST(StructureFaults, WithoutIntegralActionTheIaeIsUnknownAndTheStaticCompensatorKnown) {
    const auto all = asked_structures();
    const Json p{{"Kp", 0.4}};
    const Json cascade =
        answer_to(all[0], changed(changed(all[0].request, "/inner/controller", p), "/outer/controller", p));
    for (const char* step : {"inner_load", "outer_load", "setpoint"}) {
        const Json& figures = cascade["performance"][step];
        EXPECT_TRUE(figures["IAE"].is_null() && figures["IE"].is_null() && figures["peak"].is_number()) << figures;
        EXPECT_THAT(figures["why_null"]["IAE"].get<std::string>(), HasSubstr("away from its target"));
    }
    EXPECT_EQ(cascade["verdict"][0]["code"], "cascade-gains-little");
    EXPECT_TRUE(cascade["verdict"][0]["figures"]["gain_inner"].is_null());

    const Json fed = answer_to(all[2], changed(all[2].request, "/feedback", p));
    for (const Json& variant : fed["variants"])
        EXPECT_EQ(variant["IAE"].is_null(), variant["kind"] == "none") << variant;
    EXPECT_NEAR(fed["variants"].back()["compensator"]["Kf"].get<double>(), 1 / 1.5, 1e-9);
    EXPECT_TRUE(fed["variants"][1]["IAE_if_wrong"]["disturbance_gain_low"].is_null());
    EXPECT_TRUE(fed["variants"][1]["IAE_if_wrong"]["plant_dead_time_long"].is_number());
    EXPECT_EQ(fed["verdict"][0]["code"], "feedforward-pays");

    const Json loops = answer_to(
        all[3], changed(all[3].request, "/controllers", Json::array({Json{{"Kp", 0.1}}, Json{{"Kp", -0.02}}})));
    EXPECT_TRUE(loops["stable"].get<bool>() && loops["cost"].is_null() && loops["IAE_load"][0][0].is_null());
    EXPECT_TRUE(loops["mu"].is_number());

    const Json sampled = answer_to(
        all[1], changed(changed(all[1].request, "/controller", {{"Kc", 3}}), "/sampled", {{"sample_time", 0.2}}));
    EXPECT_TRUE(sampled["sampled"]["responses"][0]["figures"][0]["IAE"].is_null());
}

TEST(StructureFaults, TheFeedbackLoopHasItsLimitInTheDrawing) {
    const AskedStructure feedforward = asked_structures()[2];
    const Json tuned = answer_to(feedforward, changed(feedforward.request, "/feedback", {{"tune", {{"Ms", 1.5}}}}));
    EXPECT_EQ(tuned["sensitivities"]["curves"][0]["limit"], 1.5);
    EXPECT_FALSE(answer_to(feedforward, feedforward.request)["sensitivities"]["curves"][0].contains("limit"));
}

TEST(StructureFaults, TheInnerMeasurementMovesBetweenItsSamples) {
    // An inner step response of 4 s, sampled every second, drives e^(-3s)/(20s+1): held samples take 0.5 s off the 3 s.
    Json t = Json::array(), d = Json::array(), y = Json::array();
    for (int k = 0; k < 160; ++k) {
        const double now = k, inner = now - 20.5, outer = inner - 3, noise = 0.002 * std::sin(37.0 * k * k);
        t.push_back(now);
        d.push_back(inner > 0 ? 1 - std::exp(-inner / 4) : 0);
        y.push_back(noise + (outer > 0 ? 1 - (20 * std::exp(-outer / 20) - 4 * std::exp(-outer / 4)) / 16 : 0));
    }
    AskedStructure cascade = asked_structures()[0];
    const Json record{{"t", t}, {"u", d}, {"y", y}};
    cascade.request["outer"] = {{"record", record}};
    const Json model = answer_to(cascade, cascade.request)["identified"][0]["model"]["plant"];
    EXPECT_NEAR(model["L"].get<double>(), 3, 0.2) << model;
}

TEST(StructureFaults, AnErrorOfARecordIsAtThatRecord) {
    const AskedStructure cascade = asked_structures()[0];
    std::vector<double> t, u, y;
    for (int k = 0; k < 40; ++k) {
        t.push_back(k);
        u.push_back(k < 10 ? 0 : 1);
        y.push_back(0);
    }
    const Json flat{{"t", t}, {"u", u}, {"y", y}};
    Json both = flat;
    u.insert(u.begin(), 3, 0.0);
    u.resize(t.size());
    both["d"] = Json::array({{{"name", "flow"}, {"values", u}}});
    expect_fault(cascade, {{"record", both}}, "/record", "The outer plant: ");
    Json own = cascade.request;
    own["outer"] = {{"record", flat}};
    expect_fault(cascade, own, "/outer/record", "");
    EXPECT_THAT(cascade_call(own.dump(), {}).body, Not(HasSubstr("inner/record")));
}

}  // namespace
}  // namespace tunewright::api
