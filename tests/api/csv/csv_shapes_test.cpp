// Files that do not have one line a sample, logs with lines of several kinds, and several runs in one file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/csv/preview.h"
#include "api/csv/record.h"

namespace tunewright::api {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CsvRecord shaped(const std::string& text, const CsvOptions& options = {}) {
    auto out = read_csv_record(text, options);
    if (auto* faults = std::get_if<std::vector<CsvFault>>(&out)) {
        ADD_FAILURE() << faults->front().where << ": " << faults->front().message;
        return {};
    }
    return std::get<CsvRecord>(std::move(out));
}

CsvFault refused_shape(const std::string& text, const CsvOptions& options = {}) {
    const auto out = read_csv_record(text, options);
    const auto* faults = std::get_if<std::vector<CsvFault>>(&out);
    return faults ? faults->front() : CsvFault{"none", ""};
}

CsvOptions chosen_by_name(const std::string& u, const std::string& y) {
    CsvOptions options;
    options.columns.u = u;
    options.columns.y = y;
    return options;
}

TEST(CsvShapes, ValuesOfTagsKeepTheirOwnTimes) {
    const CsvRecord record = shaped(
        "entity_id,state,last_changed\n"
        "sensor.room_temperature,20.0,2024-03-09T23:55:00Z\nswitch.heater,off,2024-03-09T23:55:00Z\n"
        "sensor.room_temperature,unavailable,2024-03-09T23:55:30Z\nswitch.heater,on,2024-03-09T23:55:42Z\n"
        "sensor.room_temperature,20.5,2024-03-09T23:56:00Z\n");
    EXPECT_THAT(record.t, ElementsAre(0, 42, 60));
    EXPECT_THAT(record.u, ElementsAre(0, 1, 1));
    EXPECT_EQ(record.y[0], 20);
    EXPECT_TRUE(std::isnan(record.y[1]));
    EXPECT_EQ(record.y[2], 20.5);
    EXPECT_THAT(record.lines, ElementsAre(2, 5, 6));
    EXPECT_EQ(record.dropped, 0);
}

TEST(CsvShapes, TagsThatDoNotSayWhichIsUAreChosenByName) {
    const std::string text = "time,tag,value\n0,A1,1\n0,B2,20\n1,A1,2\n1,B2,21\n2,A1,2\n2,B2,22\n3,A1,2\n3,B2,23\n";
    EXPECT_NE(refused_shape(text).where, "none");
    EXPECT_THAT(refused_shape(text).message, HasSubstr("\"A1\" and \"B2\""));
    EXPECT_THAT(shaped(text, chosen_by_name("A1", "B2")).y, ElementsAre(20, 21, 22, 23));
}

TEST(CsvShapes, JsonOfEveryLayoutIsTheSameRecord) {
    for (const char* text :
         {R"([{"t": 0, "u": 1, "y": 2}, {"t": 1, "u": 1, "y": 3.5}, {"t": 2, "u": 0, "y": null}])",
          R"({"data": [{"t": 0, "u": 1, "y": 2}, {"t": 1, "u": 1, "y": 3.5}, {"t": 2, "u": 0}]})",
          R"({"t": [0, 1, 2], "u": [1, 1, 0], "y": [2, 3.5, null]})",
          "[\n {\"t\": 0,\n  \"u\": 1, \"y\": 2},\n {\"t\": 1, \"u\": 1, \"y\": 3.5},\n {\"t\": 2, \"u\": 0}]"}) {
        const CsvRecord record = shaped(text);
        EXPECT_THAT(record.t, ElementsAre(0, 1, 2)) << text;
        EXPECT_THAT(record.u, ElementsAre(1, 1, 0)) << text;
        EXPECT_EQ(record.y[1], 3.5) << text;
    }
    EXPECT_NE(refused_shape(R"([{"t": 0, "u": 1)").where, "none");
}

TEST(CsvShapes, TheFamilyOfLinesWithTheNamedColumnsIsTheRecord) {
    std::string log;
    for (int k = 0; k < 600; ++k)
        log += "Receive: " + std::to_string(k) + " seq: 15, oid=7 next=" + std::to_string(k) + " value=5\n";
    for (int k = 0; k < 20; ++k) log += "at=" + std::to_string(k) + " bias=3 level=" + std::to_string(k) + "\n";
    CsvOptions options = chosen_by_name("bias", "level");
    options.columns.t = "at";
    EXPECT_EQ(shaped(log, options).t.size(), 20u);
}

std::string run_of(int rows, int step_at, double first = 0) {
    std::string out;
    for (int k = 0; k < rows; ++k)
        out += std::to_string(first + k) + "," + std::to_string(k < step_at ? 0 : 1) + "," +
               std::to_string(k < step_at ? 20.0 : 20.0 + std::min(10, k - step_at)) + "\n";
    return out;
}

TEST(CsvShapes, ASeparatorInsideTheTagsSeparatesNothing) {
    std::string text = "SourceTimestamp,NodeId,Value,StatusCode\n";
    for (int k = 0; k < 9; ++k) {
        const std::string at = "2024-03-09T23:55:0" + std::to_string(k) + "Z,ns=2;s=Tank.";
        text += at + "Level," + std::to_string(20 + k) + ",Good\n" + at + "Valve,5,Good\n";
    }
    CsvOptions options = chosen_by_name("ns=2;s=Tank.Valve", "ns=2;s=Tank.Level");
    EXPECT_EQ(shaped(text, options).t.size(), 9u);
}

TEST(CsvRuns, TheLongestThatTestsSomethingIsReadUnlessAnotherIsChosen) {
    const std::string text = "t,u,y\n" + run_of(90, 1000) + run_of(20, 5) + "t,u,y\n" + run_of(40, 10, 3);
    const CsvRecord record = shaped(text);
    EXPECT_EQ(record.run, 3);
    EXPECT_EQ(record.runs.size(), 3u);
    EXPECT_EQ(record.t.size(), 40u);
    EXPECT_EQ(record.lines.front(), 113);
    EXPECT_FALSE(record.runs[0].tests);
    EXPECT_THAT(record.unread, HasSubstr("run 2, lines 92 to 111"));
    CsvOptions options;
    options.run = 2;
    EXPECT_EQ(shaped(text, options).t.size(), 20u);
    EXPECT_EQ(preview_csv(text, options).run, 2);
    options.run = 4;
    EXPECT_EQ(refused_shape(text, options).where, "run");
}

TEST(CsvRuns, ACountdownIsTheTimeBeforeTheTest) {
    const CsvRecord record = shaped("t,u,y\n3,0,20\n2,0,20\n1,0,20\n0,0,20\n" + run_of(30, 5, 1));
    EXPECT_EQ(record.t.size(), 34u);
    EXPECT_EQ(record.t.front(), -3);
    EXPECT_TRUE(record.runs.empty());
    EXPECT_TRUE(std::ranges::is_sorted(record.t));
}

TEST(CsvRuns, RowsOutOfOrderAndTheNewestFirstAreNoRuns) {
    EXPECT_TRUE(shaped("t,u,y\n" + run_of(20, 5) + "12,1,27\n" + run_of(20, 0, 20)).runs.empty());
    std::string newest_first = "t,u,y\n";
    for (int k = 30; k > 0; --k) newest_first += std::to_string(k) + ",1,2\n";
    EXPECT_TRUE(shaped(newest_first).runs.empty());
    EXPECT_EQ(shaped(newest_first).t.front(), 30);
}

TEST(CsvColumns, RadioAndBatteryAreNeverTheInput) {
    for (const char* name : {"linkquality", "rssi", "battery", "battery_voltage", "humidity", "wifi_rssi", "lqi"}) {
        const std::string text = "time," + std::string(name) + ",temperature\n0,75,20\n1,79,21\n2,66,22\n3,66,23\n";
        EXPECT_EQ(refused_shape(text).where, "columns/u") << name;
    }
}

TEST(CsvColumns, AFileWithoutUTakesTheStepAsGiven) {
    CsvOptions options;
    options.u_step = {5, 30};
    const CsvRecord record = shaped("t,y\n0,20\n1,20\n2,21\n", options);
    EXPECT_THAT(record.u, ElementsAre(30, 30, 30));
    EXPECT_THAT(refused_shape("t,y\n0,20\n1,20\n2,21\n").message, HasSubstr("u_step"));
    options.columns.u = "y";
    EXPECT_EQ(refused_shape("t,y\n0,20\n1,20\n2,21\n", options).where, "u_step");
}

}  // namespace
}  // namespace tunewright::api
