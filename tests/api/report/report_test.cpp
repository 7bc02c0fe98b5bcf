// The report without a server: its drawings, its escaping, and texts that are not results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/report/change_sheet.h"
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

std::size_t count(std::string_view text, std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
        ++found;
    return found;
}

constexpr const char* kNewEntry = R"({"method": "robust", "controller": {"form": "ideal", "Kp": 2, "Ti": 10},
    "verdict": [{"level": "good", "text": "first"}, {"level": "note", "text": "second"}], "robustness": {"Ms": 1.4},
    "performance": {"load": {"IAE": 5}}, "replay": {"figures": {"IAE": 7, "travel": 9}, "IAE_ratio": 0.7,
    "IAE_ratio_low": 0.6, "IAE_ratio_high": 0.8}})";
constexpr const char* kTodaysEntry = R"({"method": "baseline", "controller": {"form": "ideal", "Kp": 1, "Ti": 20},
    "robustness": {"Ms": 1.2}, "performance": {"load": {"IAE": 20}}})";

std::variant<std::string, Problem> sheet_of(const std::string& entries, std::string_view index = "0") {
    const std::string result = R"({"replay": {"figures": {"IAE": 10, "travel": 8}}, "controllers": [)" + entries + "]}";
    return change_sheet_html({result}, index, {});
}

TEST(Report, AChangeSheetHasTodaysAndTheNewFigures) {
    const std::string sheet = std::get<std::string>(sheet_of(std::string(kNewEntry) + "," + kTodaysEntry));
    for (const char* entry : {"0", "1"})
        for (const char* place : {"controller/Kp", "controller/Ti", "robustness/Ms", "performance/load/IAE"})
            EXPECT_THAT(sheet, HasSubstr(std::string("data-at=\"/result/controllers/") + entry + "/" + place + "\""));
    for (const char* place : {"replay/figures/IAE", "controllers/0/replay/figures/IAE",
                              "controllers/0/replay/IAE_ratio", "controllers/0/replay/IAE_ratio_low",
                              "controllers/0/replay/IAE_ratio_high", "controllers/0/replay/figures/travel"})
        EXPECT_THAT(sheet, HasSubstr(std::string("data-at=\"/result/") + place + "\""));
    EXPECT_THAT(sheet, HasSubstr(">first<"));
    EXPECT_THAT(sheet, Not(HasSubstr(">second<")));
}

TEST(Report, AChangeSheetWithoutTodaysSettingsHasACellToWriteIntoForEach) {
    constexpr std::string_view kEmpty = "<td></td>";
    const std::string known = std::get<std::string>(sheet_of(std::string(kNewEntry) + "," + kTodaysEntry));
    const std::string unknown = std::get<std::string>(sheet_of(kNewEntry));
    EXPECT_EQ(count(unknown, kEmpty), count(known, kEmpty) + 2);  // Kp and Ti
}

TEST(Report, TheHeadOfAChangeSheetNamesTheProductOnlyIfItTakesTheSettings) {
    const auto sheet = [](const std::string& controller, const std::string& typed) {
        const std::string result = R"({"controllers": [{"method": "x", "controller": )" + controller + typed + "}]}";
        return std::get<std::string>(change_sheet_html({result, R"({"implement": {"product": "klipper"}})"}, "0", {}));
    };
    const std::string linear = R"({"form": "ideal", "Kp": 2, "Ti": 10})";
    const std::string nonlinear = R"({"form": "npid", "Kp": 2, "Ti": 10, "delta_r": 5})";
    const std::string typed = R"(, "as_entered": {"product": "klipper", "as_typed": {"pid_Kp": "2.00"}})";
    EXPECT_THAT(sheet(linear, typed), HasSubstr("Settings of Klipper heater (control: pid), by: x"));
    EXPECT_THAT(sheet(nonlinear, ""), HasSubstr("Settings of a nonlinear PID controller, by: x"));
    EXPECT_THAT(sheet(nonlinear, ""), HasSubstr("To enter, in the nonlinear form"));
    EXPECT_THAT(sheet(linear, ""), HasSubstr("Controller settings, by: x"));
    for (const std::string& controller : {linear, nonlinear})
        EXPECT_THAT(sheet(controller, ""), Not(HasSubstr("Klipper")));
}

TEST(Report, AChangeSheetTellsWhichOfTodaysSettingsMustBeNotedToGoBack) {
    const auto entered = [](const char* method, const std::string& typed, const std::string& notes) {
        return R"({"method": ")" + std::string(method) + R"(", "controller": {"form": "ideal", "Kp": 1, "Ti": 20},
            "as_entered": {"product": "emerson_deltav_standard", "as_typed": )" +
               typed + R"(, "notes": )" + notes + "}}";
    };
    const std::string next = entered("robust", R"({"GAIN": "2.0", "STRUCTURE": "I on error"})", "[]");
    const std::string assumed = R"([{"code": "default", "detail": "STRUCTURE = PI on error."}])";
    const auto sheet_with = [&](const std::string& typed) {
        return std::get<std::string>(sheet_of(next + "," + entered("baseline", typed, assumed)));
    };
    const std::string in_part = sheet_with(R"({"GAIN": "1.0"})");
    EXPECT_EQ(count(in_part, "<td>note it: ______</td>"), 1u);
    EXPECT_THAT(in_part, HasSubstr("settings: STRUCTURE = PI on error."));
    EXPECT_THAT(in_part, HasSubstr("settings are unknown: before you change anything, write the value"));
    const std::string whole = sheet_with(R"({"GAIN": "1.0", "STRUCTURE": "PI on error"})");
    EXPECT_EQ(count(whole, "note it"), 0u);
    EXPECT_THAT(whole, Not(HasSubstr("settings are unknown")));
}

TEST(Report, AChangeSheetNamesWhatSpeaksAgainstTheChange) {
    const std::string sheet = std::get<std::string>(sheet_of(R"({"method": "robust", "controller": {"form": "ideal",
        "Kp": 2, "Ti": 10}, "options": {"setpoint": {"overshoot": 5}}, "robustness": {"Ms": 1.4}, "verdict": [
        {"code": "robust", "level": "good", "text": "first"}, {"code": "peaks", "level": "note", "text": "plain"},
        {"code": "replay", "level": "warning", "text": "1.13 times worse"},
        {"code": "overshoot", "level": "note", "text": "a lag", "figures": {"design_percent": 5}}],
        "performance": {"setpoint": {"overshoot_percent": 12.59}},
        "implemented": {"robustness": {"Ms": 1.45}, "performance": {"setpoint": {"overshoot_percent": 12.6}},
        "region": {"worst_Ms": 1.5, "stable_fraction": 1}}, "region": {"worst_Ms": 1.3, "stable_fraction": 1}})"));
    for (const char* said : {">first<", ">1.13 times worse<", ">a lag<"}) EXPECT_THAT(sheet, HasSubstr(said));
    EXPECT_THAT(sheet, Not(HasSubstr(">plain<")));
    EXPECT_EQ(count(sheet, "above the limit"), 1u);
    EXPECT_THAT(sheet, HasSubstr("/implemented/region/worst_Ms"));
    EXPECT_THAT(sheet, Not(HasSubstr("/controllers/0/region/worst_Ms")));
}

TEST(Report, WhatChangesNothingHasNoChangeSheet) {
    const auto status = [](const std::variant<std::string, Problem>& answer) {
        return std::holds_alternative<Problem>(answer) ? std::get<Problem>(answer).status : 200;
    };
    EXPECT_EQ(status(sheet_of(std::string(kNewEntry) + "," + kTodaysEntry, "")), 200);
    EXPECT_EQ(status(sheet_of(std::string(kNewEntry) + "," + kTodaysEntry, "1")), 422);
    EXPECT_EQ(status(sheet_of(kTodaysEntry, "")), 422);
    EXPECT_EQ(status(sheet_of(R"({"method": "simc", "error": {"detail": "none"}})")), 404);
    EXPECT_EQ(status(change_sheet_html({R"({"range": {}})"}, "", {})), 404);
    EXPECT_EQ(status(change_sheet_html({"{"}, "", {})), 400);
}

TEST(Report, DatesAreInTheReadersTime) {
    EXPECT_EQ(date_words("2024-05-01T12:00:59Z", {}), "2024-05-01 12:00 UTC");
    EXPECT_EQ(date_words("2024-05-01T12:00:59Z", 120), "2024-05-01 14:00 UTC+02:00");
    EXPECT_EQ(date_words("2024-02-29T23:40:00Z", 330), "2024-03-01 05:10 UTC+05:30");
    EXPECT_EQ(date_words("2024-01-01T03:20:00Z", -570), "2023-12-31 17:50 UTC-09:30");
    EXPECT_EQ(date_words("2023-12-31T23:59:00Z", 1), "2024-01-01 00:00 UTC+00:01");
    for (const char* other : {"", "yesterday", "2024-13-01T12:00:00Z", "2024-05-01Txx:00:00Z", "T"})
        EXPECT_EQ(date_words(other, 60), other);
}

ReportWords words_named(const std::string& name) {
    ReportWords words;
    words.name = name;
    return words;
}

TEST(Report, SheetsOfABatchKeepItsOrderAndListTheLoopsWithoutOne) {
    const std::string result = R"({"controllers": [)" + std::string(kNewEntry) + "," + kTodaysEntry + "]}";
    const std::string todays = R"({"controllers": [)" + std::string(kTodaysEntry) + "]}";
    ChangeSheets sheets;
    sheets.add({0, "succeeded", {result}, "", words_named("A")});
    sheets.add({1, "failed", {""}, R"({"detail": "T is missing."})", words_named("B <b>")});
    sheets.add({2, "succeeded", {result}, "", {}});
    sheets.add({3, "cancelled", {""}, "", {}});
    sheets.add({4, "running", {""}, "", {}});
    sheets.add({5, "succeeded", {todays}, "", {}});
    sheets.add({6, "succeeded", {R"({"range": {}})"}, "", {}});
    EXPECT_EQ(sheets.loops(), 7U);
    const std::string page = sheets.page("unit 7", "change-sheet.html?from=7");
    EXPECT_EQ(count(page, "<div class=\"sheet\">"), 3);
    EXPECT_LT(page.find("A: change sheet"), page.find("Loop 3: change sheet"));
    for (const char* reason : {"B &lt;b&gt;</td><td>T is missing.", "Cancelled.", "Not tuned yet.",
                               "today&#39;s settings, which change nothing", "An operating range has no change sheet"})
        EXPECT_THAT(page, HasSubstr(reason));
    EXPECT_THAT(page, HasSubstr("href=\"change-sheet.html?from=7\""));
    EXPECT_THAT(sheets.page("unit 7", ""), Not(HasSubstr("next part")));
}

TEST(Report, ThePolicyNamesTheStylesheet) {
    EXPECT_THAT(report_policy(), testing::StartsWith("default-src 'none'; style-src 'sha256-"));
}

}  // namespace
}  // namespace tunewright::api
