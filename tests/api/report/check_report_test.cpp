// The report and the table of a check: the work list, its order and its reasons, and a page for each loop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"
#include "api/report/check_words.h"
#include "api/report/report.h"
#include "api/report/terminal/terminal.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A sticking valve disturbs a second loop; a third is healthy. The last of `loops` comes first in the ranking.
constexpr const char* kLoops = R"([
  {"tag": "FIC<2>", "quality": {"rows": 400, "duration": 399, "remarks": []}, "service": {"automatic": null,
      "why_null": {"automatic": "The record has no column of the mode."}},
   "oscillation": {"found": false, "period": null, "periods": []},
   "cause": {"verdict": "healthy", "confidence": "likely", "evidence": [{"code": "quiet", "value": 1, "detail": "Quiet."}],
      "alternatives": ["sluggish"], "size": null},
   "performance": {"mean_error": 0.1, "harris": null, "why_null": {"harris": "The record is too short."}},
   "action": {"code": "none", "owner": "nobody", "detail": "Nothing to do."},
   "trend": {"t": [0, 1], "y": [1, 2], "u": [3, 4]}, "excerpt": {"t": [], "y": [], "u": []}},
  {"tag": "LIC104", "quality": {"rows": 400, "remarks": [{"code": "gap", "detail": "A gap of 20 s.", "level": "warning"}]},
   "service": {}, "oscillation": {"found": true, "period": 54.2, "periods": []},
   "cause": {"verdict": "external", "confidence": "likely", "evidence": [], "alternatives": []},
   "performance": {"mean_error": 0.2}, "action": {"code": "find-source", "owner": "process", "detail": "Find it."}},
  {"tag": "FIC101", "quality": {"rows": 400, "remarks": []}, "service": {"automatic": 0.98},
   "oscillation": {"found": true, "period": 54.04, "regularity": 31.5, "periods": [{"period": 54.04, "period_error": 0.2,
      "regularity": 31.5, "share": 0.92, "amplitude": 0.62}]},
   "cause": {"verdict": "stiction", "confidence": "sure", "evidence": [
      {"code": "regularity", "value": 31.5, "limit": 1, "detail": "It oscillates."},
      {"code": "valve-explains", "value": 0.8, "detail": "A valve that sticks explains it."}],
      "alternatives": ["backlash"], "size": 3.068, "jump": 0.5, "period": 54.04},
   "performance": {"mean_error": 0.39, "harris": {"low": 0.01, "high": 0.34, "delays": [1, 14]}, "idle_index": -0.9},
   "action": {"code": "repair-valve", "owner": "instruments", "detail": "Have the valve looked at."},
   "cure": {"detail": "Until the repair:", "valve": {"stops": [{"detail": "With a gap the cycle ends."}]}},
   "trend": {"t": [0, 1, 2], "y": [1, 2, 1], "r": [1, 1, 1], "u": [3, 4, 3]},
   "excerpt": {"t": [0, 1, 2], "y": [1, 2, 1], "u": [3, 4, 3]}, "spectrum": {"x": [1, 10, 100], "y": [0, 0.9, 0.1]}}])";

constexpr const char* kRanking = R"([{"loop": 2, "gain": 0.2274, "share": 0.576, "money": null, "effort": 3},
    {"loop": 1, "gain": null, "share": null, "money": null, "effort": 3, "after": 2,
     "why_null": {"gain": "From outside.", "share": "From outside."}},
    {"loop": 0, "gain": 0, "share": 0, "money": null, "effort": 0}])";

std::string result(const std::string& ranking = kRanking) {
    return R"({"units": {"time": "s", "y": "m3/h", "u": "%"}, "version": "0", "request_hash": "h", "partial": false,
        "clusters": [{"period": 54.1, "loops": [2, 1], "source": 2, "detail": "FIC101 moves first."}],
        "cascades": [{"master": 1, "slave": 0}],
        "ranking": )" +
           ranking + R"(, "loops": )" + std::string(kLoops) + "}";
}

std::string report_of(const std::string& text) {
    auto report = report_html({text, R"({"loops": [], "name": "Unit 7"})"}, "", {});
    return std::holds_alternative<std::string>(report) ? std::get<std::string>(report)
                                                       : std::get<Problem>(report).detail;
}

std::size_t occurrences(std::string_view text, std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
        ++found;
    return found;
}

TEST(CheckReport, SaysWhatEndsTheCycleOfAValveUntilItsRepair) {
    EXPECT_EQ(occurrences(report_of(result()), "With a gap the cycle ends."), 1u);
    EXPECT_EQ(occurrences(check_text(result()), "  With a gap the cycle ends.\n"), 1u);
}

TEST(CheckReport, HasAPageForThePlantAndOneForEachLoop) {
    const std::string page = report_of(result());
    EXPECT_THAT(page, HasSubstr("<h1>Unit 7: loop check</h1>"));
    EXPECT_THAT(page, HasSubstr("3 loops: 1 sticking valve, 1 disturbed from outside, 1 healthy."));
    EXPECT_EQ(occurrences(page, "<section class=\"loop\">"), 3u);
    EXPECT_THAT(page, HasSubstr("<h1>FIC&lt;2&gt;</h1>"));
    EXPECT_LT(page.find("<h1>FIC101</h1>"), page.find("<h1>LIC104</h1>"));
    EXPECT_LT(page.find("<h1>LIC104</h1>"), page.find("<h1>FIC&lt;2&gt;</h1>"));
    EXPECT_THAT(page, HasSubstr("break-before: page"));
    EXPECT_THAT(page, HasSubstr("<h2>Request</h2>"));
}

TEST(CheckReport, TheWorkListHasGainsWithUnitsOrTheReason) {
    const std::string page = report_of(result());
    EXPECT_THAT(page, HasSubstr("<span data-at=\"/result/ranking/0/gain\">0.2274</span> m3/h"));
    EXPECT_THAT(page, HasSubstr("<td>known when FIC101 is mended</td>"));
    EXPECT_THAT(page, HasSubstr("<td>instruments</td><td>work on the plant</td>"));
    EXPECT_THAT(page, Not(HasSubstr("Money")));
    const std::string alone = report_of(result(R"([{"loop": 1, "gain": null, "effort": 3,
        "why_null": {"gain": "From outside."}, "money": 12}])"));
    EXPECT_THAT(alone, HasSubstr("<td>From outside.</td>"));
    EXPECT_THAT(alone, HasSubstr("<span data-at=\"/result/ranking/0/money\">12</span>"));
    EXPECT_EQ(occurrences(alone, "<section class=\"loop\">"), 3u) << "a loop without a rank is not lost";
}

TEST(CheckReport, GroupsAndCascadesAreNamedByTheirTags) {
    const std::string page = report_of(result());
    EXPECT_THAT(page, HasSubstr("FIC101, LIC104</th><td><span data-at=\"/result/clusters/0/period\">54.1</span>"));
    EXPECT_THAT(page, HasSubstr("FIC101 moves first."));
    EXPECT_THAT(page, HasSubstr("LIC104 gives FIC&lt;2&gt; its set point."));
    EXPECT_THAT(page, HasSubstr("Mend FIC101 first: it disturbs this loop."));
}

TEST(CheckReport, ALoopHasEvidenceRemarksFiguresAndPictures) {
    const std::string page = report_of(result());
    for (const char* part :
         {"<li>It oscillates.</li><li>A valve that sticks explains it.</li>", "The record does not exclude: Backlash.",
          "Have the valve looked at. Whose work it is: instruments.", "<li>A gap of 20 s.</li>",
          "Dead band and stick (%)</th><td><span data-at=\"/result/loops/2/cause/size\">3.068",
          "data-at=\"/result/loops/2/performance/harris/high\">0.34", "Mean error (m3/h)",
          "In automatic: none. The record has no column of the mode.", "Harris range: none. The record is too short.",
          "Measurement against output (PV against OP)", "Power of the error"})
        EXPECT_THAT(page, HasSubstr(part));
    EXPECT_EQ(occurrences(page, "Whole record, output"), 4u) << "two loops have a trend; title and caption";
}

TEST(CheckReport, WhatOnlyResemblesACheckNeverStopsTheService) {
    for (const char* text :
         {R"({"loops": [], "ranking": []})", R"({"loops": [1, {"tag": 3}], "ranking": [{"loop": -1}, 5]})",
          R"({"loops": [{"cause": [], "trend": {"t": 1}}], "ranking": [{"loop": 9}], "clusters": [{"loops": [7]}]})",
          R"({"loops": [{"cause": {"verdict": "new", "alternatives": [2]}}], "ranking": {}, "clusters": 3})"}) {
        EXPECT_NO_THROW((void)report_html({text, ""}, "", {})) << text;
        EXPECT_NO_THROW((void)check_text(text)) << text;
    }
    EXPECT_EQ(report_html({result(), ""}, "0", {}).index(), 1u) << "a loop is no controller";
}

TEST(CheckReport, TheTableIsInTheOrderOfTheRanking) {
    const std::string shown = check_text(result());
    EXPECT_THAT(shown, HasSubstr("3 loops: 1 sticking valve, 1 disturbed from outside, 1 healthy.\n\n"
                                 "   loop    cause                   confidence  do first              owner        "
                                 "gain (m3/h)  of the error  period (s)\n"
                                 "1  FIC101  Sticking valve          sure        repair the valve      instruments  "
                                 "      0.227          58 %          54\n"
                                 "2  LIC104  Disturbed from outside  likely      correct FIC101 first  process      "
                                 "          -             -        54.2\n"
                                 "3  FIC<2>  Healthy                 likely      nothing               –            "
                                 "          0           0 %           -\n"));
    EXPECT_THAT(shown, HasSubstr("Oscillate together: FIC101, LIC104\n  FIC101 moves first.\n"));
    EXPECT_THAT(shown, HasSubstr("Cascade: LIC104 gives FIC<2> its set point.\n"));
    EXPECT_THAT(shown, HasSubstr("\nFIC101\n  It oscillates.\n  A valve that sticks explains it.\n  Have the valve"));
    EXPECT_THAT(shown, Not(HasSubstr("Nothing to do.")));
    EXPECT_EQ(check_text("no check"), "no check\n");
}

TEST(CheckReport, NewerCodesAreShownAsTheyAre) {
    EXPECT_EQ(verdict_title("stiction"), "Sticking valve");
    EXPECT_EQ(verdict_title("unheard-of"), "unheard-of");
    EXPECT_EQ(action_title("check-range"), "look at the limit");
    EXPECT_EQ(effort_title(7), "–");
}

/// The judgement of a batch with `count` loops: every third one is healthy, the others tight; the last comes first.
std::string batch_of(std::size_t count) {
    Json loops = Json::array(), ranking = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
        loops.push_back({{"tag", "FIC" + std::to_string(i)},
                         {"index", i},
                         {"job", "j"},
                         {"units", {{"time", "min"}, {"y", "m3/h"}}},
                         {"cause", {{"verdict", i % 3 == 0 ? "healthy" : "tight"}}}});
        ranking.push_back({{"loop", count - 1 - i}, {"gain", 0.5}});
    }
    return Json{{"loops", loops}, {"ranking", ranking}, {"complete", false}, {"failed", 1}}.dump();
}

TEST(BatchReport, HasPagesForTheFirstLoopsWithACause) {
    BatchReport report(batch_of(100));
    const std::vector<std::size_t> pages = report.pages();
    ASSERT_EQ(pages.size(), 50u);
    EXPECT_EQ(pages[0], 98u) << "99 is healthy";
    EXPECT_EQ(pages[1], 97u);
    EXPECT_EQ(pages[2], 95u);
    report.add_drawings(98, R"({"loops": [{}, {"trend": {"t": [0, 1], "y": [1, 2], "u": [3, 4]}}]})", 1);
    report.add_drawings(97, "", 0);
    report.add_failed("FIC<x>", "FIC.PV has no number.");
    report.add_failed("", "");
    const std::string page = report.html(
        "Unit 7", {.job = "", .name = "", .date = "2026-05-04T06:00:00Z", .origin = "", .utc_offset_min = {}});
    EXPECT_EQ(occurrences(page, "<section class=\"loop\">"), 50u);
    EXPECT_EQ(occurrences(page, "m3/h</td>"), 100u) << "each gain in the unit of its loop";
    EXPECT_EQ(occurrences(page, "Whole record, output"), 2u) << "of the loop with drawings; title and caption";
    for (const char* part :
         {"<h1>Unit 7: loop check</h1>", "2026-05-04 06:00 UTC", "100 loops: 34 healthy, 66 tuned too tight.",
          "The pages of 50 loops follow: the first with a cause in the order of the work list, which has all 100 "
          "loops.",
          "The batch has not ended", "FIC&lt;x&gt;: FIC.PV has no number.", "Without a name: It has no result."})
        EXPECT_THAT(page, HasSubstr(part));
    EXPECT_THAT(page, Not(HasSubstr("<h2>Request</h2>")));
}

TEST(BatchReport, OfFewLoopsHasAPageForEach) {
    EXPECT_EQ(BatchReport(batch_of(50)).pages().size(), 50u);
    EXPECT_EQ(BatchReport(batch_of(51)).pages().size(), 34u);
    // The saved judgement of a batch is a check for `tunewright report` and for a terminal.
    const std::string page = report_of(batch_of(3));
    EXPECT_EQ(occurrences(page, "<section class=\"loop\">"), 3u);
    EXPECT_THAT(check_text(batch_of(3)), HasSubstr("gain (m3/h)"));
}

TEST(CheckReport, FindingsAboutTheFilesAreNamed) {
    Json noted = Json::parse(result());
    noted["notes"] = {"TI103 is not checked."};
    EXPECT_THAT(report_of(noted.dump()), HasSubstr("<h2>Files</h2><ul><li>TI103 is not checked.</li></ul>"));
    EXPECT_THAT(check_text(noted.dump()), HasSubstr("\nNote: TI103 is not checked.\n"));
}

}  // namespace
}  // namespace tunewright::api
