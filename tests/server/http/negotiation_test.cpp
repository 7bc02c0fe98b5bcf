#include "server/http/app/negotiation.h"

#include <gtest/gtest.h>

namespace tunewright::server::http {
namespace {

Request with(const std::string& name, const std::string& value) {
    Request request;
    request.headers.emplace(name, value);
    return request;
}

std::optional<int> wait_of(const std::string& prefer) {
    const auto wait = preferred_wait(with("Prefer", prefer));
    return wait ? std::optional<int>(static_cast<int>(wait->count())) : std::nullopt;
}

TEST(Negotiation, PreferWaitIsReadAsRfc7240WritesIt) {
    EXPECT_EQ(wait_of("wait=10"), 10);
    EXPECT_EQ(wait_of("respond-async, WAIT = 5; strict"), 5);
    EXPECT_EQ(wait_of("wait=0"), 0);
    EXPECT_EQ(wait_of("wait=\"7\""), 7);
    EXPECT_EQ(wait_of("wait=3600"), 60) << "at most a minute";
    EXPECT_EQ(wait_of("wait=99999999999999"), 60);
    for (const char* none : {"", "wait", "wait=", "wait=-1", "wait=1.5", "wait=ten", "waiting=3", "wait=\"\"",
                             "wait=\"", "wait=-99999999999999"})
        EXPECT_EQ(wait_of(none), std::nullopt) << none;
    EXPECT_FALSE(preferred_wait({}));
}

TEST(Negotiation, AcceptTakesRangesAndHonoursZeroQuality) {
    const std::string json = "application/json";
    EXPECT_TRUE(accepts({}, json));
    for (const char* yes :
         {"*/*", "application/*", "Application/JSON", "text/html, application/json;q=0.5", "*/*;q=0.1"})
        EXPECT_TRUE(accepts(with("accept", yes), json)) << yes;
    for (const char* no : {"text/html", "application/xml", "application/json;q=0", "*/*; q=0.000"})
        EXPECT_FALSE(accepts(with("accept", no), json)) << no;
}

TEST(Negotiation, TheNarrowestRangeOfAllAcceptFieldsDecides) {
    EXPECT_FALSE(accepts(with("Accept", "*/*, text/csv;q=0"), "text/csv"));
    EXPECT_EQ(preference(with("Accept", "text/*;q=0.3, */*;q=0.1, text/csv;q=0.7"), "text/csv"), 0.7);
    EXPECT_EQ(preference(with("Accept", "text/*;q=0.3, */*;q=0.1"), "text/csv"), 0.3);
    EXPECT_EQ(preference(with("Accept", "text/*;q=0.3, */*;q=0.1"), "application/json"), 0.1);
    Request two = with("Accept", "text/html");
    two.headers.emplace("accept", "text/csv;q=0.2");
    EXPECT_EQ(preference(two, "text/csv"), 0.2);
    EXPECT_FALSE(accepts(two, "application/json"));
}

TEST(Negotiation, JsonBodiesAreKnownByTheirTypeOrByNone) {
    EXPECT_TRUE(sends_json({}));
    for (const char* yes : {"application/json", "application/json; charset=utf-8", "APPLICATION/JSON",
                            "application/merge-patch+json", "application/x-www-form-urlencoded"})
        EXPECT_TRUE(sends_json(with("Content-Type", yes))) << yes;
    for (const char* no : {"text/plain", "application/jsonp", "multipart/form-data"})
        EXPECT_FALSE(sends_json(with("Content-Type", no))) << no;
}

TEST(Negotiation, AKnownTagTurnsTheAnswerInto304WithoutBody) {
    const std::string tag = entity_tag("body");
    EXPECT_NE(tag, entity_tag("Body"));
    EXPECT_EQ(tag, entity_tag("body"));
    for (const std::string& known : {tag, "W/" + tag, "\"x\", " + tag, std::string("*")}) {
        Response response = json_response("body");
        apply_entity_tag(with("If-None-Match", known), response, tag);
        EXPECT_EQ(response.status, 304) << known;
        EXPECT_EQ(response.body, "");
    }
    Request two = with("If-None-Match", "\"x\"");
    two.headers.emplace("If-None-Match", tag);
    Response same = json_response("body");
    apply_entity_tag(two, same, tag);
    EXPECT_EQ(same.status, 304);
    Response response = json_response("body");
    apply_entity_tag(with("If-None-Match", "\"other\""), response, tag);
    EXPECT_EQ(response.status, 200);
}

}  // namespace
}  // namespace tunewright::server::http
