// Messages of the Model Context Protocol: versions, methods, errors, and texts that are no message.
#include <gtest/gtest.h>

#include <tuple>

#include "plain_host.h"

namespace tunewright::api::mcp {
namespace {

Json error_of(std::string_view text) {
    PlainHost host;
    const Json answer = Json::parse(answered(text, host));
    EXPECT_EQ(answer.at("jsonrpc"), "2.0");
    EXPECT_FALSE(answer.contains("result"));
    return answer;
}

TEST(McpProtocol, ARevisionThatIsSpokenIsRepeatedAndAnyOtherGetsTheNewest) {
    PlainHost host;
    for (const auto& [asked, spoken] : {std::pair{"2024-11-05", "2024-11-05"},
                                        {"2025-03-26", "2025-03-26"},
                                        {"2025-06-18", "2025-06-18"},
                                        {"2031-01-01", "2025-06-18"}}) {
        const Json hello = answer_to("initialize", {{"protocolVersion", asked}}, host).at("result");
        EXPECT_EQ(hello.at("protocolVersion"), spoken);
        EXPECT_TRUE(is_revision(hello.at("protocolVersion").get<std::string>()));
    }
    EXPECT_EQ(answer_to("initialize", Json::object(), host).at("error").at("code"), kInvalidParams);
}

TEST(McpProtocol, WhatHasNoIdIsNotAnswered) {
    PlainHost host;
    for (const char* text :
         {R"({"jsonrpc":"2.0","method":"notifications/initialized"})",
          R"({"jsonrpc":"2.0","method":"tools/call","params":{"name":"tune"}})",
          R"({"jsonrpc":"2.0","id":4,"result":{}})", R"([{"jsonrpc":"2.0","method":"notifications/initialized"}])"})
        EXPECT_EQ(answered(text, host), "") << text;
}

TEST(McpProtocol, TheIdComesBackAsItWasSent) {
    PlainHost host;
    for (const char* id : {"1", "-7", "9007199254740993", "\"a\\\"b\"", "\"\""})
        EXPECT_EQ(answered(R"({"jsonrpc":"2.0","method":"ping","id":)" + std::string(id) + "}", host),
                  R"({"jsonrpc":"2.0","id":)" + std::string(id) + R"(,"result":{}})");
    for (const char* id : {"1.5", "true", "[]", "{}"})
        EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","method":"ping","id":)" + std::string(id) + "}").at("error").at("code"),
                  kInvalidRequest)
            << id;
}

TEST(McpProtocol, AMessageThatIsNotJsonIsAnsweredUnderItsOwnId) {
    for (const auto& [text, id, code] :
         {std::tuple{R"({"jsonrpc":"2.0","id":3,"method":"ping","params":{"x":NaN}})", Json(3), kParseError},
          {R"({"params":{"id":9,"x":1e999},"jsonrpc":"2.0","id":"q","method":"ping"})", Json("q"), kInvalidRequest},
          {R"({"text":"\"id\":5","x":[{"id":6}],"y":})", Json(), kParseError},
          {R"({"id":)", Json(), kParseError},
          {R"({"id":"abc)", Json(), kParseError},
          {"", Json(), kParseError}}) {
        const Json answer = error_of(text);
        EXPECT_EQ(answer.at("id"), id) << text;
        EXPECT_EQ(answer.at("error").at("code"), code) << text;
    }
}

TEST(McpProtocol, MessagesOfAnotherFormAreRefused) {
    for (const char* text : {"7", "null", "[]", R"({"id":1,"method":"ping"})",
                             R"({"jsonrpc":"1.0","id":1,"method":"ping"})", R"({"jsonrpc":"2.0","id":1})",
                             R"({"jsonrpc":"2.0","id":1,"method":7})", R"({"jsonrpc":"2.0","id":1,"method":""})"})
        EXPECT_EQ(error_of(text).at("error").at("code"), kInvalidRequest) << text;
    EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"ping","params":[1]})").at("error").at("code"),
              kInvalidParams);
    EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"tune"})").at("error").at("code"), kMethodNotFound);
}

TEST(McpProtocol, AnArrayGetsOneAnswerForEachRequest) {
    PlainHost host;
    const Json answers = Json::parse(answered(
        R"([{"jsonrpc":"2.0","id":1,"method":"ping"},{"jsonrpc":"2.0","method":"x"},7,{"jsonrpc":"2.0","id":2,"method":"x"}])",
        host));
    ASSERT_EQ(answers.size(), 3U);
    EXPECT_EQ(answers[0].at("id"), 1);
    EXPECT_EQ(answers[1].at("error").at("code"), kInvalidRequest);
    EXPECT_EQ(answers[2].at("error").at("code"), kMethodNotFound);
    Json many = Json::array();
    for (std::size_t i = 0; i <= kMaxBatch; ++i) many.push_back({{"jsonrpc", "2.0"}, {"id", i}, {"method", "ping"}});
    EXPECT_EQ(error_of(many.dump()).at("error").at("code"), kInvalidRequest);
}

TEST(McpProtocol, AResourceIsTheWholeAnswerOfAJob) {
    PlainHost host;
    EXPECT_EQ(answer_to("resources/read", {{"uri", "tunewright://answer/7"}}, host).at("error").at("code"),
              kResourceNotFound);
    host.job = ToolJob{"7", "succeeded", R"({"name":"q"})", R"({"x":0.123456789012345})", "", ""};
    const Json read = answer_to("resources/read", {{"uri", "tunewright://answer/7"}}, host).at("result");
    EXPECT_EQ(read.at("contents").at(0).at("text"),
              R"({"id":"7","status":"succeeded","request":{"name":"q"},"result":{"x":0.123456789012345}})");
    EXPECT_EQ(answer_to("resources/list", Json::object(), host).at("result").at("resources").at(0).at("uri"),
              "tunewright://answer/7");
    host.job->result = "\"" + std::string(2 << 20, 'x') + "\"";
    EXPECT_EQ(answer_to("resources/read", {{"uri", "tunewright://answer/7"}}, host).at("error").at("code"),
              kInternalError);
    for (const char* uri : {"", "file:///etc/passwd", "tunewright://answer", "tunewright://answer/8"})
        EXPECT_EQ(answer_to("resources/read", {{"uri", uri}}, host).at("error").at("code"), kResourceNotFound) << uri;
}

}  // namespace
}  // namespace tunewright::api::mcp
