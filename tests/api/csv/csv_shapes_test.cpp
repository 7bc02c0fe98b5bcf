// Files that do not have one line per sample, logs with lines of several kinds, and several runs in one file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/csv/csv_record.h"
#include "api/csv/preview.h"

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

// Each tag has times of its own; a table with one line for each second has the same content.
TEST(CsvShapes, SetPointAndDisturbancesOfALongTableHoldUntilTheirNextValue) {
    std::string text = "time,tag,value\n";
    const auto r_at = [](int t) { return t < 20 ? 30 : t < 45 ? 40 : 35; };
    const auto d_at = [](int t) { return t < 33 ? 1.5 : 2.5; };
    const auto line = [&](double t, const std::string& tag, double value) {
        text += std::to_string(t) + "," + tag + "," + std::to_string(value) + "\n";
    };
    line(0, "SP", 30);
    line(0, "flow", 1.5);
    for (int t = 0; t < 60; ++t) {
        line(t + 0.1, "valve", t / 10);
        if (t > 0 && r_at(t) != r_at(t - 1)) line(t + 0.2, "SP", r_at(t));
        if (t > 0 && d_at(t) != d_at(t - 1)) line(t + 0.25, "flow", d_at(t));
        line(t + 0.3, "temp", 20 + t);
    }
    CsvOptions options = chosen_by_name("valve", "temp");
    options.columns.r = "SP";
    options.columns.d = {"flow"};
    const CsvRecord record = shaped(text, options);
    ASSERT_EQ(record.r.size(), record.t.size());
    ASSERT_EQ(record.d.size(), 1u);
    double d = std::nan(""), d_changed = 0;
    int rows = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        const double value = record.d[0].values[i];
        if (!std::isnan(value) && value == 2.5 && d != 2.5) d_changed = record.t[i];
        if (!std::isnan(value)) d = value;
        EXPECT_FALSE(std::isnan(record.u[i]));
        if (std::isnan(record.y[i])) continue;
        ++rows;
        const int t = static_cast<int>(record.y[i]) - 20;
        EXPECT_EQ(record.u[i], t / 10) << t;
        EXPECT_EQ(record.r[i], r_at(t)) << t;
        EXPECT_EQ(d, d_at(t)) << t;
    }
    EXPECT_EQ(rows, 60);
    // A disturbance changes at its own time; times count from the first row.
    EXPECT_NEAR(d_changed - record.t.front(), 33.25 - 0.1, 1e-9);
    EXPECT_EQ(record.dropped, 0);
}

TEST(CsvShapes, ALineWithTheSetPointOrADisturbanceAloneIsOne) {
    CsvOptions options;
    options.columns.d = {"flow"};
    const CsvRecord record =
        shaped("t,u,y,SP,flow\n0,1,20,30,5\n1,1,20,,\n1.5,,,40,\n2,1,21,,\n2.5,,,,6\n3,1,22,,\n", options);
    EXPECT_THAT(record.t, ElementsAre(0, 1, 2, 2.5, 3));
    EXPECT_THAT(record.r, ElementsAre(30, 30, 40, 40, 40));
    EXPECT_EQ(record.d[0].values[3], 6);
    EXPECT_EQ(record.u[3], 1);
    EXPECT_EQ(record.dropped, 0);
}

TEST(CsvShapes, DisturbancesOfOneNameAreToldApartByTheirColumns) {
    CsvOptions options;
    options.columns.d = {4, 5};
    const CsvRecord record = shaped("t,u,y,flow,flow\n0,1,20,1,2\n1,1,20,1,3\n2,1,21,4,2\n", options);
    EXPECT_EQ(record.d[0].name, "flow (column 4)");
    EXPECT_EQ(record.d[1].name, "flow (column 5)");
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

TEST(CsvRuns, MoreThanAThousandAreNoOrderOfTimes) {
    std::string text = "t,u,y\n";
    for (int k = 0; k < 1001; ++k)
        for (int i = 0; i < 4; ++i) text += std::to_string(i) + ",1,2\n";
    EXPECT_EQ(refused_shape(text).where, "csv");
    EXPECT_THAT(refused_shape(text).message, HasSubstr("The times start again 1000 times; at most 1000 runs"));
}

// Each of these took minutes, or gigabytes, for a few megabytes of input.
TEST(CsvLimits, WhatGrowsWithTheNamesInAFileIsRefused) {
    std::string wide = "t,u,y", row = "1,2,3";
    for (int k = 0; k < 300'000; ++k) {
        wide += ",c" + std::to_string(k);
        row += ",1";
    }
    std::string tags = "time,tag,value\n", events, json = "[{";
    for (int k = 0; k < 2000; ++k) tags += "1,tag" + std::to_string(k % 600) + ",5\n";
    for (int k = 0; k < 5000; ++k)
        events += "name" + std::to_string(k) + ": " + std::to_string(k) + ".5 1.0\n" + std::to_string(k) + ".7 22.1\n";
    for (int k = 0; k < 1000; ++k) json += (k > 0 ? ",\"a" : "\"a") + std::to_string(k) + "\": 1";
    std::string many = json + "}", members = json;
    for (int k = 0; k < 50'001; ++k) many += ",{\"t\":1}";
    for (int k = 0; k < 4000; ++k) members += ",\"b" + std::to_string(k) + "\":1";
    for (const auto& [text, limit] : {std::pair{wide + "\n" + row + "\n" + row + "\n", "at most 4000 are read"},
                                      {tags, "more than 500 tags"},
                                      {events, "more than 500 names"},
                                      {many + "]", "50 million cells"},
                                      {members + "},{\"a1\":2}]", "at most 4000 are read"}}) {
        const CsvFault fault = refused_shape(text);
        EXPECT_EQ(fault.where, "csv");
        EXPECT_THAT(fault.message, ::testing::AllOf(HasSubstr(limit), ::testing::ContainsRegex("Export|Leave out")));
        EXPECT_THAT(preview_csv(text, {}).problems, ::testing::SizeIs(1));
    }
}

std::string message_file() {
    std::string log = "FMT,1,9,RATE,Qff,TimeUS,R,ROut\nFMT,2,9,BAT,Qf,TimeUS,Volt\n";
    for (int k = 0; k < 20; ++k) {
        const std::string at = std::to_string(k * 1000);
        log += "RATE," + at + "," + std::to_string(k) + "," + std::to_string(k / 10) + "\n";
        if (k % 2 == 0) log += "BAT," + at + "," + std::to_string(12 - k / 10) + "\n";
    }
    return log;
}

TEST(CsvShapes, AMessageLogGivesColumnsOfEveryRoleByName) {
    CsvOptions options = chosen_by_name("RATE.ROut", "RATE.R");
    options.columns.d = {"BAT.Volt"};
    options.columns.t = "TimeUS";
    const CsvRecord record = shaped(message_file(), options);
    ASSERT_EQ(record.d.size(), 1u);
    EXPECT_EQ(record.d[0].name, "BAT.Volt");
    EXPECT_EQ(std::ranges::count_if(record.y, [](double y) { return !std::isnan(y); }), 20);
    options.columns.t.reset();
    options.columns.u = 2;
    EXPECT_EQ(refused_shape(message_file(), options).where, "columns/u");
    EXPECT_THAT(refused_shape(message_file(), options).message,
                HasSubstr("u is column 2; in a log of messages each kind has its own columns"));
    options = chosen_by_name("RATE.ROut", "RATE.R");
    options.columns.d = {"BAT.Amps"};
    EXPECT_EQ(refused_shape(message_file(), options).where, "columns/d/0");
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
    // The step is at the first row, even if y is missing there.
    const CsvRecord late = shaped("t,y\n0,\n1,\n2,20\n3,21\n", options);
    EXPECT_THAT(late.t, ElementsAre(0, 2, 3));
    EXPECT_THAT(late.u, ElementsAre(30, 30, 30));
    options.columns.u = "y";
    EXPECT_EQ(refused_shape("t,y\n0,20\n1,20\n2,21\n", options).where, "u_step");
}

TEST(CsvColumns, AStepIsNotGivenWhereTheFileHasU) {
    CsvOptions options;
    options.u_step = {0, 5};
    for (const char* name : {"u", "output", "OP", "co"}) {
        const std::string text = "t," + std::string(name) + ",y\n0,0,20\n1,0,20\n2,5,21\n3,5,22\n";
        EXPECT_EQ(refused_shape(text, options).where, "u_step") << name;
        EXPECT_THAT(refused_shape(text, options).message, HasSubstr("\"" + std::string(name) + "\""));
    }
    // A column that stands still holds no step; one that may be u is named.
    EXPECT_THAT(shaped("t,u,y\n0,5,20\n1,5,20\n2,5,21\n", options).unread_column, "");
    const std::string tagged = "t,TIC101.OP,y\n0,0,20\n1,0,20\n2,5,21\n3,5,22\n";
    EXPECT_THAT(shaped(tagged, options).unread_column, HasSubstr("\"TIC101.OP\" may be u and was not read"));
    EXPECT_THAT(preview_csv(tagged, options).notes, ::testing::Contains(HasSubstr("TIC101.OP")));
}

}  // namespace
}  // namespace tunewright::api
