// The report without a server: its drawings, its escaping, and texts that are not results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/report/html.h"
#include "api/report/plot.h"
#include "api/report/report.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(Report, TextBecomesMarkupByEscapingOnly) {
    EXPECT_EQ(Html("<b>&\"'\x01\n").markup(), "&lt;b&gt;&amp;&quot;&#39;\n");
    EXPECT_EQ(element("td", "a < b", {{"title", "\"><script>"}, {"class", ""}}).markup(),
              "<td title=\"&quot;&gt;&lt;script&gt;\">a &lt; b</td>");
    EXPECT_EQ(element("p", Html("x") + element("b", "y")).markup(), "<p>x<b>y</b></p>");
}

TEST(Report, TicksAreOneTwoOrFive) {
    EXPECT_THAT(ticks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
    EXPECT_THAT(ticks(-0.5, 0.6, 5), ElementsAre(-0.5, 0, 0.5));
    EXPECT_THAT(ticks(0, 1e-9, 5).size(), 6);
    EXPECT_TRUE(ticks(1, 1, 5).empty());
    EXPECT_THAT(log_ticks(0.05, 1), ElementsAre(0.05, 0.1, 0.2, 0.5, 1));
    EXPECT_THAT(log_ticks(1e-3, 1e3), ElementsAre(0.001, 0.01, 0.1, 1, 10, 100, 1000));
}

TEST(Report, ADrawingHasFiniteNumbersOnly) {
    Plot plot{.title = "y", .x_label = "t", .y_label = "y", .traces = {}};
    EXPECT_TRUE(drawn(plot).empty());
    plot.traces.push_back({.name = "a", .line = Line::proposal, .x = {0, 1, 2, 3}, .y = {0, 1e300, NAN, 2}});
    const std::string markup = drawn(plot).markup();
    EXPECT_THAT(markup, HasSubstr("<figure>"));
    EXPECT_THAT(markup, Not(HasSubstr("nan")));
    EXPECT_THAT(markup, Not(HasSubstr("inf")));
    plot.traces[0] = {.name = "flat", .line = Line::today, .x = {0, 1}, .y = {5, 5}};
    EXPECT_THAT(drawn(plot).markup(), HasSubstr("stroke-dasharray=\"6 4\""));
}

TEST(Report, WhatIsNoResultIsRefused) {
    const auto refused = [](const char* text) {
        const auto report = report_html({text, ""}, "", {});
        return std::holds_alternative<Problem>(report) ? std::get<Problem>(report).status : 200;
    };
    EXPECT_EQ(refused("{"), 400);
    EXPECT_EQ(refused("{}"), 404);
    EXPECT_EQ(refused("[1]"), 404);
    EXPECT_EQ(refused(R"({"controllers": []})"), 404);
    EXPECT_EQ(refused(R"({"controllers": [{"method": "x", "error": {"detail": "no"}}]})"), 404);
    // A text that only resembles a result never stops the service.
    for (const char* text :
         {R"({"controllers": [{"controller": 3}]})", R"({"controllers": [{"controller": {"Kp": "<b>"}}]})",
          R"({"controllers": [{"controller": {}, "verdict": [1, {"text": 2}], "options": [1]}]})",
          R"({"controllers": [{"controller": {}, "warnings": {"a": 1}, "responses": {"load": {"t": 1, "y": [1]}}}]})",
          R"({"controllers": [{"controller": {}}], "request": {"plant": {"type": 3}}, "model": 5})"}) {
        EXPECT_NO_THROW((void)report_html({text, ""}, "0", {})) << text;
    }
}

TEST(Report, ThePolicyNamesTheStylesheet) {
    EXPECT_THAT(report_policy(), testing::StartsWith("default-src 'none'; style-src 'sha256-"));
}

}  // namespace
}  // namespace tunewright::api
