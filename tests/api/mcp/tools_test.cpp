// The tools: their list fits a context, each example is a right call, and answers show what the engine says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "../support.h"
#include "api/mcp/short_answer.h"
#include "api/mcp/tools.h"
#include "plain_host.h"

namespace tunewright::api::mcp {
namespace {

using testing::HasSubstr;

const Json kTune = Json::parse(R"json({"plant": "2 e^(-3s)/(10s+1)", "tune": [{"method": "robust", "Ms": 1.4}],
    "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 10},
    "implement": {"product": "emerson_deltav_standard", "y_span": [0, 100], "u_span": [0, 100]}})json");

void visit(const Json& value, const std::function<void(const Json&)>& see) {
    see(value);
    if (value.is_structured())
        for (const Json& member : value) visit(member, see);
}

TEST(McpTools, TheListFitsAContext) {
    PlainHost host;
    const std::string list = tool_list(host);
    EXPECT_LT(list.size(), 30'000U);
    const Json tools_of_list = Json::parse(list).at("tools");
    EXPECT_EQ(tools_of_list.size(), tools().size());
    for (const Json& tool : tools_of_list) {
        EXPECT_EQ(tool.at("inputSchema").at("type"), "object");
        EXPECT_LT(tool.at("description").get<std::string>().size(), 600U) << tool.at("name");
        visit(tool, [](const Json& part) {
            if (!part.is_object()) return;
            EXPECT_FALSE(part.contains("$ref")) << part;
            for (const auto& [name, member] : part.items()) EXPECT_FALSE(name.starts_with("x-")) << name;
        });
    }
}

TEST(McpTools, EachMemberOfASchemaIsOneOfTheContract) {
    PlainHost host;
    for (const Tool& tool : tools()) {
        ShownTypes shown;
        const Json schema = tool.arguments(shown);
        for (const auto& [name, member] : schema.at("properties").items()) {
            const std::string text = text_of(called(tool.name, {{name, Json::array({Json::object()})}}, host));
            EXPECT_EQ(text.find(name + " is not a field here"), std::string::npos) << tool.name << ": " << text;
            EXPECT_EQ(text.find(name + " is not possible in a tool"), std::string::npos) << tool.name << ": " << text;
        }
    }
}

TEST(McpTools, EachExampleIsARightCall) {
    PlainHost host;
    for (const Tool& tool : tools()) {
        const Json arguments = Json::parse(tool.example);
        if (std::string_view(tool.example).find("...") != std::string_view::npos) continue;  // a record cut short
        if (tool.name == std::string_view("job_status")) continue;
        EXPECT_FALSE(called(tool.name, arguments, host).contains("isError")) << tool.name;
    }
}

TEST(McpTools, AToolThatStoresAJobSaysSo) {
    PlainHost host;
    for (const bool stores : {false, true}) {
        host.stores = stores;
        const Json list = Json::parse(tool_list(host)).at("tools");
        for (std::size_t i = 0; i < list.size(); ++i) {
            const Json& hints = list[i].at("annotations");
            EXPECT_EQ(hints.at("readOnlyHint"), !(stores && tools()[i].makes_job)) << tools()[i].name;
            EXPECT_EQ(hints.at("destructiveHint"), false);
        }
    }
}

TEST(McpTools, AShortAnswerHasTheFiguresAndSentencesOfTheWholeOne) {
    PlainHost host;
    const Json answer = called("tune", kTune, host);
    const Json whole = Json::parse(host.job->result);
    const Json& best = whole.at("controllers").at(whole.at("ranking").at(0).get<std::size_t>());
    const Json& figures = answer.at("structuredContent");
    EXPECT_LT(answer.dump().size(), 5000U);

    for (const char* name : {"Kp", "Ti", "Td"})
        EXPECT_NEAR(figures["best"]["controller"][name].get<double>(), best["controller"][name].get<double>(),
                    5e-5 * best["controller"][name].get<double>())
            << name;
    EXPECT_EQ(figures["best"]["settings"], best["as_entered"]["as_typed"]);
    EXPECT_NEAR(figures["best"]["gain_margin"].get<double>(), best["robustness"]["gain_margin"].get<double>(), 1e-3);
    EXPECT_EQ(figures["controllers"].size(), 2U);
    ASSERT_EQ(figures["best"]["verdict"].size(), best["verdict"].size());
    for (std::size_t i = 0; i < best["verdict"].size(); ++i) {
        for (const char* part : {"code", "level", "text"})
            EXPECT_EQ(figures["best"]["verdict"][i][part], best["verdict"][i][part]);
        EXPECT_THAT(text_of(answer), HasSubstr(best["verdict"][i]["text"].get<std::string>()));
    }
    for (const auto& [name, typed] : best["as_entered"]["as_typed"].items())
        EXPECT_THAT(text_of(answer), HasSubstr(name + " " + typed.get<std::string>()));
    EXPECT_EQ(figures["whole"]["page"], "/#/jobs/7/design");
}

TEST(McpTools, AComparisonHasItsFirstRowsAlone) {
    PlainHost host;
    const Json answer = called("compare", {{"plant", "2 e^(-3s)/(10s+1)"}}, host);
    const Json whole = Json::parse(host.job->result);
    const Json& rows = answer.at("structuredContent").at("controllers");
    EXPECT_GT(whole.at("controllers").size(), rows.size());
    EXPECT_EQ(rows.size(), 12U);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i]["index"], whole["ranking"][i]);
    EXPECT_LT(answer.dump().size(), 6000U);
}

TEST(McpTools, NumbersAreRoundedToFiveDigits) {
    EXPECT_EQ(rounded(Json::parse(R"({"a":0.123456789,"b":[12345678.9,-1e-9],"c":7,"d":"0.123456789","e":null})")),
              Json::parse(R"({"a":0.12346,"b":[12346000.0,-1e-9],"c":7,"d":"0.123456789","e":null})"));
    EXPECT_EQ(one_line(Json::parse(R"({"form":"ideal","Kp":0.84999999,"filter":{"Tf":2}})")),
              "form ideal, Kp 0.85, filter.Tf 2");
}

TEST(McpTools, TermsThatActOutsideTheAnswerAreRefused) {
    PlainHost host;
    for (const auto& [name, value] : {std::pair{"notify", Json{{"url", "https://example.com"}}},
                                      {"not_before", Json("2026-01-01T00:00:00Z")},
                                      {"unique", Json(true)},
                                      {"priority", Json("low")}}) {
        Json arguments = kTune;
        arguments[name] = value;
        const Json answer = called("tune", arguments, host);
        EXPECT_TRUE(answer.value("isError", false));
        EXPECT_EQ(answer["structuredContent"]["error"]["errors"][0]["pointer"], std::string("/") + name);
        EXPECT_FALSE(host.job.has_value());
    }
}

TEST(McpTools, ARefusalHasEachFaultOfTheServiceAndARightCall) {
    PlainHost host;
    const Json arguments = Json::parse(R"({"plant":{"type":"fopdt","K":"2","T":-0,"tau":1}})");
    const Json answer = called("tune", arguments, host);
    const auto prepared = prepare_job(arguments.dump());
    const auto& problem = std::get<Problem>(prepared);
    ASSERT_GT(problem.errors.size(), 1U);
    for (const FieldError& error : problem.errors)
        EXPECT_THAT(text_of(answer), HasSubstr(error.pointer + ": " + error.detail));
    EXPECT_THAT(text_of(answer), HasSubstr("A right call of tune: {"));
}

TEST(McpTools, ARefusalIsShortWhateverWasSent) {
    PlainHost host;
    Json many = Json::object();
    for (int i = 0; i < 900; ++i) many["member_" + std::to_string(i)] = i;
    EXPECT_LT(called("tune", many, host).dump().size(), 20'000U);
    EXPECT_EQ(called("tune", many, host)["structuredContent"]["error"]["errors"].size(), 20U);
    EXPECT_LT(called("tune", {{std::string(50'000, 'a'), 1}}, host).dump().size(), 5000U);
}

TEST(McpTools, SettingsAreConvertedInBothDirections) {
    PlainHost host;
    const Json spans{{"y_span", {0, 200}}, {"u_span", {0, 100}}};
    Json there{{"product", "emerson_deltav_standard"}, {"controller", {{"form", "ideal"}, {"Kp", 0.5}, {"Ti", 20}}}};
    there.update(spans);
    const Json settings = called("settings", there, host).at("structuredContent").at("settings");
    EXPECT_EQ(settings.at("GAIN"), "1.00");  // Kp Sy/Su = 0.5 200/100
    Json back{{"product", "emerson_deltav_standard"}, {"settings", {{"GAIN", 1}, {"RESET", 20}, {"RATE", 0}}}};
    back.update(spans);
    const Json controller = called("settings", back, host).at("structuredContent").at("controller");
    EXPECT_DOUBLE_EQ(controller.at("Kp").get<double>(), 0.5);
    EXPECT_DOUBLE_EQ(controller.at("Ti").get<double>(), 20);
}

TEST(McpTools, AJobThatRunsIsNotAnError) {
    PlainHost host;
    host.job = ToolJob{"7", "running", "{}", "", "", R"({"fraction":0.25,"stage":"tune","message":"Tunes."})"};
    const Json answer = called("job_status", {{"job", "7"}}, host);
    EXPECT_FALSE(answer.contains("isError"));
    EXPECT_EQ(answer["structuredContent"]["fraction"], 0.25);
    host.job->status = "failed";
    host.job->error = R"({"type":"timeout","title":"Timeout","status":504,"detail":"Too slow."})";
    EXPECT_THAT(text_of(called("job_status", {{"job", "7"}}, host)), HasSubstr("Too slow."));
}

}  // namespace
}  // namespace tunewright::api::mcp
