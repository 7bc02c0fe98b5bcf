// Exports in the formats of historians, loggers and spreadsheets.
#include <gmock/gmock.h>

#include <cmath>

#include "api/csv/csv_record.h"
#include "api/csv/time_stamp.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

struct Export {
    const char* name;
    std::string text;
    std::vector<double> t, u, y;
    CsvOptions options = {};
};

void PrintTo(const Export& item, std::ostream* out) { *out << item.name; }

std::string utf16(const std::string& ascii, bool big_endian, bool mark) {
    std::string out;
    const auto unit = [&](char high, char low) {
        out += big_endian ? high : low;
        out += big_endian ? low : high;
    };
    if (mark) unit('\xFE', '\xFF');
    for (const char c : ascii) unit('\0', c);
    return out;
}

CsvOptions spacing(double dt) {
    CsvOptions options;
    options.dt = dt;
    return options;
}

CsvOptions minutes() {
    CsvOptions options;
    options.time_unit = "min";
    options.time_unit_given = true;
    return options;
}

CsvOptions columns(std::optional<ColumnChoice> t, ColumnChoice u, ColumnChoice y) {
    CsvOptions options;
    options.columns = {std::move(t), std::move(u), std::move(y)};
    return options;
}

class Exports : public testing::TestWithParam<Export> {};

TEST_P(Exports, AreReadAsTheyAre) {
    const Export& item = GetParam();
    const auto out = read_csv_record(item.text, item.options);
    if (const auto* faults = std::get_if<std::vector<CsvFault>>(&out))
        FAIL() << faults->front().where << ": " << faults->front().message;
    const auto& record = std::get<CsvRecord>(out);
    const auto same = [](const std::vector<double>& got, const std::vector<double>& want, const char* name) {
        ASSERT_EQ(got.size(), want.size()) << name;
        for (std::size_t i = 0; i < got.size(); ++i) {
            if (std::isnan(want[i]))
                EXPECT_TRUE(std::isnan(got[i])) << name << " " << i;
            else
                EXPECT_NEAR(got[i], want[i], 1e-6 * std::max(1.0, std::abs(want[i]))) << name << " " << i;
        }
    };
    same(record.t, item.t, "t");
    same(record.u, item.u, "u");
    same(record.y, item.y, "y");
}

const double kNone = std::nan("");

const std::vector<Export> kExports = {
    {"pi_datalink",
     "Timestamp,TIC101.PV,TIC101.SP,TIC101.OP\n21-Nov-26 14:05:06,20.5,21,40\n21-Nov-26 14:05:07,Bad Input,21,45\n"
     "21-Nov-26 14:05:08,I/O Timeout,21,45\n",
     {0, 1, 2},
     {40, 45, 45},
     {20.5, kNone, kNone}},
    {"ignition",
     "\"t_stamp\",\"Valve\",\"Temp\"\n\"2026-11-21 14:05:06.250\",\"40\",\"20.5\"\n\"2026-11-21 14:05:06.500\",\"41\","
     "\"20.6\"\n",
     {0, 0.25},
     {40, 41},
     {20.5, 20.6}},
    {"ignition_words",
     "\"Date\",\"OP\",\"PV\"\n\"Nov 21, 2026 2:05:06 PM\",40,20\n\"Nov 21, 2026 2:05:16 PM\",41,20\n",
     {0, 10},
     {40, 41},
     {20, 20}},
    {"wonderware",
     "DateTime,TT101.PV,CV101.OP\n11/21/2026 11:59:59.500 PM,20.5,40\n11/22/2026 12:00:00.500 AM,(null),41\n",
     {0, 1},
     {40, 41},
     {20.5, kNone}},
    {"deltav",
     "Time,FIC-101/PID1/PV.CV,FIC-101/PID1/SP.CV,FIC-101/PID1/OUT.CV\n0,1,2,3\n1,4,5,6\n",
     {0, 1},
     {3, 6},
     {1, 4}},
    {"wincc_columns",
     "\"TimeString\";\"TIC_PV_IN\";\"TIC_LMN\"\n\"21.11.2026 14:05:06\";20,5;40,25\n\"21.11.2026 14:05:07\";20,75;41\n",
     {0, 1},
     {40.25, 41},
     {20.5, 20.75}},
    {"excel_german",
     "sep=;\nDatum/Zeit;Stellwert [%];Istwert [\xC2\xB0"
     "C];\n31.12.2026 23:59:59;1.040,5;20,25;\n01.01.2027 00:00:00;40;-3;\n",
     {0, 1},
     {1040.5, 40},
     {20.25, -3}},
    {"excel_german_windows_1252",
     "Zeit;Stellgr\xF6\xDF"
     "e;Temperatur (\xB0"
     "C)\r\n0;1,5;20\r\n1;2,5;21\r\n",
     {0, 1},
     {1.5, 2.5},
     {20, 21}},
    {"utf16_tabs", utf16("time\tu\ty\r\n0\t1\t2\r\n1\t1\t3\r\n", false, true), {0, 1}, {1, 1}, {2, 3}},
    {"utf16_big_endian", utf16("time\tu\ty\r\n0\t1\t2\r\n1\t1\t3\r\n", true, true), {0, 1}, {1, 1}, {2, 3}},
    {"utf16_without_mark", utf16("time,u,y\n0,1,2\n1,1,3\n", false, false), {0, 1}, {1, 1}, {2, 3}},
    {"labview",
     "LabVIEW "
     "Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\nChannels\t2\t\t\nSamples\t3\t3\t\n"
     "X0\t0.0\t0.0\t\n***End_of_Header***\t\t\t\nX_Value\tValve\tTemperature\tComment\n0.000\t1.5\t20.0\t\n"
     "0.100\t1.5\t20.5\t\n0.200\t2.5\t21.0\t\n",
     {0, 0.1, 0.2},
     {1.5, 1.5, 2.5},
     {20, 20.5, 21}},
    {"logger_with_preamble",
     "Device: Logger 3000\nStart: 2026-11-21\n\nTime (min),Heater (%),Temp (degC)\n0,10,20\n0.5,20,21\n",
     {0, 30},
     {10, 20},
     {20, 21}},
    {"numpy_savetxt", "# t u y\n0.0e+00 1.0e+00 2.0e+00\n5.0e-01 1.0e+00 3.0e+00\n", {0, 0.5}, {1, 1}, {2, 3}},
    {"columns_of_blanks",
     "   t      u      y\n 0.0    1.0    2.0\n 0.5    1.0   -3.0\n10.0    2.0   -3.5\n",
     {0, 0.5, 10},
     {1, 1, 2},
     {2, -3, -3.5}},
    {"numbered_rows", "#,Time,PV,OP\n1,0,2,3\n2,1,4,5\n", {0, 1}, {3, 5}, {2, 4}},
    {"pandas_index", ",time,u,y\n0,10,1,2\n1,20,3,4\n", {10, 20}, {1, 3}, {2, 4}},
    {"bars", "time|op|pv\n0|1|2\n1|3|4\n", {0, 1}, {1, 3}, {2, 4}},
    {"date_and_time_apart",
     "Date,Time,OP,PV\n21/11/2026,23:59:59,1,2\n22/11/2026,00:00:00,3,4\n",
     {0, 1},
     {1, 3},
     {2, 4}},
    {"blanks_with_stamps",
     "date time u y\n2026-11-21 23:59:58 1 2\n2026-11-21 23:59:59 3 4\n2026-11-22 00:00:00 5 6\n",
     {0, 1, 2},
     {1, 3, 5},
     {2, 4, 6}},
    {"days_first", "time;u;y\n03/04/2026 23:59:59;1;2\n04/04/2026 00:00:00;1;3\n", {0, 1}, {1, 1}, {2, 3}},
    {"months_first", "time;u;y\n4/3/2026 23:59:59;1;2\n4/4/2026 00:00:00;1;3\n", {0, 1}, {1, 1}, {2, 3}},
    {"days_first_over_the_twelfth",
     "time;u;y\n12/11/2026 23:59:59;1;2\n13/11/2026 00:00:00;1;3\n",
     {0, 1},
     {1, 1},
     {2, 3}},
    {"zones", "time,u,y\n2026-10-25T02:59:59+02:00,1,2\n2026-10-25T02:00:00+01:00,1,3\n", {0, 1}, {1, 1}, {2, 3}},
    {"end_of_summer_time",
     "time,u,y\n2026-10-25 02:59:58,1,2\n2026-10-25 02:59:59,1,2\n2026-10-25 02:00:00,1,3\n2026-10-25 02:00:01,1,3\n",
     {0, 1, 2, 3},
     {1, 1, 1, 1},
     {2, 2, 3, 3}},
    {"unix_milliseconds", "timestamp,u,y\n1795269906000,1,2\n1795269906500,1,3\n", {0, 0.5}, {1, 1}, {2, 3}},
    {"spreadsheet_days",
     "Date,u,y\n46347.5,1,2\n46347.50001157407,1,3\n46347.50002314815,1,3\n",
     {0, 1, 2},
     {1, 1, 1},
     {2, 3, 3}},
    {"spreadsheet_days_of_a_clock",
     "Time,OP,PV\n46085.3,1,2\n46085.30001157407,1,3\n46085.30002314815,1,3\n",
     {0, 1, 2},
     {1, 1, 1},
     {2, 3, 3}},
    {"days_of_datenum",
     "Zeit;u;y\n740046,25;1;2\n740046,256944444;1;3\n740046,263888889;1;3\n",
     {0, 600, 1200},
     {1, 1, 1},
     {2, 3, 3}},
    {"seconds_late_in_a_run",
     "Time,u,y\n46085.30,1,2\n46085.31,1,3\n46085.32,1,3\n",
     {46085.30, 46085.31, 46085.32},
     {1, 1, 1},
     {2, 3, 3}},
    {"units_in_cells", "time,valve,temp\n0 s,10 %,20.5 degC\n1 s,11 %,20.6 degC\n", {0, 1}, {10, 11}, {20.5, 20.6}},
    {"seconds_in_cells_for_minutes", "time,u,y\n0 s,1,2\n30 s,1,3\n", {0, 0.5}, {1, 1}, {2, 3}, minutes()},
    {"thousands_american", "time,u,y\n0,\"1,040.5\",20\n1,\"12,345\",21.5\n", {0, 1}, {1040.5, 12345}, {20, 21.5}},
    {"thousands_swiss", "time;u;y\n0;1'040.5;20\n1;2'000;21.5\n", {0, 1}, {1040.5, 2000}, {20, 21.5}},
    {"thousands_french", "temps;commande;mesure\n0;1 040,5;20\n1;2 000;21,5\n", {0, 1}, {1040.5, 2000}, {20, 21.5}},
    {"no_headings_u_and_y_by_content",
     "0,20.1,5\n1,20.2,5\n2,20.3,5\n3,20.2,6\n4,20.7,6\n5,21.9,6\n",
     {0, 1, 2, 3, 4, 5},
     {5, 5, 5, 6, 6, 6},
     {20.1, 20.2, 20.3, 20.2, 20.7, 21.9}},
    {"unknown_headings_u_and_y_by_content",
     "Time,CH1,CH2\n0,20.1,5\n1,20.2,5\n2,20.3,5\n3,20.2,6\n4,20.7,6\n5,21.9,6\n",
     {0, 1, 2, 3, 4, 5},
     {5, 5, 5, 6, 6, 6},
     {20.1, 20.2, 20.3, 20.2, 20.7, 21.9}},
    {"set_point_is_neither", "Time,SP,PV,CO\n0,1,2,3\n1,1,4,5\n", {0, 1}, {3, 5}, {2, 4}},
    {"numbered_names", "Time,OP1,PV1\n0,1,2\n1,1,4\n", {0, 1}, {1, 1}, {2, 4}},
    {"quality_beside_the_value",
     "time,PV,PV Quality,OP,OP Quality\n0,1,Good,2,Good\n1,1.5,Bad,3,Good\n",
     {0, 1},
     {2, 3},
     {1, 1.5}},
    {"trailing_separators", "t,u,y,,\n0,1,2,,\n1,1,3,,\n", {0, 1}, {1, 1}, {2, 3}},
    {"first_line_without_values", "t,u,y\n0,,\n1,1,2\n2,1,3\n", {1, 2}, {1, 1}, {2, 3}},
    {"old_line_ends", "t,u,y\r0,1,2\r1,1,3\r", {0, 1}, {1, 1}, {2, 3}},
    {"serial_log_without_time", "u,y\n0,20.5\n50,20.6\n", {0, 0.25}, {0, 50}, {20.5, 20.6}, spacing(0.25)},
    {"chosen_among_many",
     "Time,TI1.PV,TI2.PV,FC1.OP\n0,1,2,3\n1,4,5,6\n",
     {0, 1},
     {3, 6},
     {2, 5},
     columns(std::nullopt, "FC1.OP", "TI2.PV")},
    {"clock_of_twelve_hours",
     "time,u,y\n11:59:59 AM,1,2\n12:00:00 PM,1,3\n1:00:00 PM,1,3\n",
     {0, 1, 3601},
     {1, 1, 1},
     {2, 3, 3}},
    {"compact_stamps",
     "Zeit;u;y\n20260304235958;1;2\n20260304235959;1;3\n20260305000001;1;3\n",
     {0, 1, 3},
     {1, 1, 1},
     {2, 3, 3}},
    {"thousands_beside_whole_numbers",
     "Zeit;OP;PV\n0;950;980\n1;1.050;999\n2;1.050;1.045\n",
     {0, 1, 2},
     {950, 1050, 1050},
     {980, 999, 1045}},
    {"thousands_with_commas", "Time,OP,PV\n0,35,980\n1,47,\"1,045\"\n", {0, 1}, {35, 47}, {980, 1045}},
    {"three_decimals_beside_fewer", "Zeit;OP;PV\n0;950;9,5\n1;951;9,045\n", {0, 1}, {950, 951}, {9.5, 9.045}},
    {"empty_row_below_the_headings",
     "Time [min],OP [%],PV [degC]\n,,\n0,35,20\n1,47,21\n",
     {0, 60},
     {35, 47},
     {20, 21}},
    {"empty_row_below_the_units", "Time;OP;PV\nmin;%;degC\n;;\n0;35;20\n1;47;21\n", {0, 60}, {35, 47}, {20, 21}},
    {"line_break_in_the_headings", "\"Time\n(min)\",\"OP\n(%)\",PV\n0,35,20\n1,47,21\n", {0, 60}, {35, 47}, {20, 21}},
    {"unit_as_the_heading", "Minuten;OP;PV\n0;35;20\n1;47;21\n", {0, 60}, {35, 47}, {20, 21}},
    {"title_with_a_date",
     "Trend Kessel 3;;\nExport;26.11.2026;\nTime;OP;PV\n0;35;20\n1;47;21\n",
     {0, 1},
     {35, 47},
     {20, 21}},
    {"long_counter_is_no_stamp",
     "t,u,y\n20260399000000,1,2\n20260399000001,1,3\n20260399000002,1,3\n",
     {20260399000000, 20260399000001, 20260399000002},
     {1, 1, 1},
     {2, 3, 3}},
};

INSTANTIATE_TEST_SUITE_P(Csv, Exports, testing::ValuesIn(kExports),
                         [](const auto& one) { return std::string(one.param.name); });

std::string first_fault(const std::string& text, const CsvOptions& options = {}) {
    const auto out = read_csv_record(text, options);
    const auto* faults = std::get_if<std::vector<CsvFault>>(&out);
    return faults ? faults->front().where + ": " + faults->front().message : "it was read";
}

TEST(Csv, SeveralTagsAreNotGuessedAmong) {
    const std::string fault = first_fault("Time,TIC101.PV,TIC102.PV,TIC101.OP\n0,1,2,3\n1,2,3,4\n");
    EXPECT_THAT(fault, HasSubstr("columns/y: Several columns may be y (the measurement): \"TIC101.PV\" and "
                                 "\"TIC102.PV\". Choose one."));
}

TEST(Csv, TwoMovingColumnsAreNotGuessedBetween) {
    EXPECT_THAT(first_fault("Time,A,B\n0,1,2\n1,2,3\n2,3.5,3.1\n3,3.6,3.4\n"),
                HasSubstr("No column is clearly u, the controller output. Choose its heading, or its number from 1. "
                          "The headings are"));
}

TEST(Csv, OneLineATagIsReadAsAColumnForEachTag) {
    const auto read = read_csv_record(
        "\"VarName\";\"TimeString\";\"VarValue\";\"Validity\";\"Time_ms\"\n"
        "\"TIC_PV\";\"21.11.2026 14:05:06\";20,5;1;46347586875,0\n"
        "\"TIC_OP\";\"21.11.2026 14:05:06\";40;1;46347586875,0\n",
        {});
    const auto& record = std::get<CsvRecord>(read);
    EXPECT_THAT(record.u, ElementsAre(40));
    EXPECT_THAT(record.y, ElementsAre(20.5));
}

TEST(Csv, DecimalCommasBetweenCommasAreRefused) {
    EXPECT_THAT(first_fault("t,u,y\n0,0,1,5,20,25\n0,5,1,5,20,5\n"),
                HasSubstr("Line 1 has 3 headings and line 2 has 6 cells. Numbers with a decimal comma need ; or tab"));
}

TEST(Csv, AnotherSeparatorInTheMiddleIsNamed) {
    EXPECT_THAT(
        first_fault("t,u,y\n0,1,2\n1,1,3\n2;1;4\n3,1,4\n"),
        HasSubstr("Line 4, column \"t\": \"2;1;4\" is not a number. The line is not separated like the others."));
}

TEST(Csv, NumbersBeyondMeasureAreRefused) {
    EXPECT_THAT(first_fault("t,u,y\n0,1,2\n1,1,1e300\n"), HasSubstr("Line 3, column \"y\": \"1e300\" is beyond 1e30"));
}

TEST(Csv, UnitsOfHeadingsAreTold) {
    CsvOptions options;
    options.unit_y = "K";
    const auto out = read_csv_record("t,u [%],y [degC]\n0,1,2\n1,1,3\n", options);
    const auto& record = std::get<CsvRecord>(out);
    EXPECT_THAT(record.notes, Contains("u is in \"%\" by the file."));
    EXPECT_THAT(record.notes,
                Contains("y is in \"degC\" by the file, and \"K\" was given: the numbers are used as they are."));
}

TEST(Csv, WhatWasAssumedAboutTimesIsTold) {
    const auto days = read_csv_record("time;u;y\n03/04/2026 23:59:59;1;2\n04/04/2026 00:00:00;1;3\n", {});
    EXPECT_THAT(std::get<CsvRecord>(days).notes, Contains(HasSubstr("Dates are read with the day first")));
    const auto clock = read_csv_record("time,u,y\n2026-10-25 02:59:59,1,2\n2026-10-25 02:00:00,1,3\n", {});
    EXPECT_THAT(std::get<CsvRecord>(clock).notes, Contains(HasSubstr("goes back by an hour at line 3")));
    const auto epoch = read_csv_record("time,u,y\n1795269906000,1,2\n1795269906500,1,3\n", {});
    EXPECT_THAT(std::get<CsvRecord>(epoch).notes, Contains(HasSubstr("Times count ms since 1970")));
}

TEST(Csv, WhatMayBeThousandsIsTold) {
    const auto notes = [](const std::string& text) { return std::get<CsvRecord>(read_csv_record(text, {})).notes; };
    EXPECT_THAT(notes("t,u,y\n0,35,\"14,250\"\n1,47,\"14,252\"\n"),
                Contains(HasSubstr("\"14,250\" are read with three decimals")));
    EXPECT_THAT(notes("t;u;y\n0;950;5\n1;1.050;6\n"), Contains(HasSubstr("\"1.050\" are read as thousands")));
    // The cell that decides may come late in the file.
    std::string late = "t,u,y\n";
    for (int i = 0; i < 300; ++i) late += std::to_string(i) + ",35,\"1,234\"\n";
    const auto read = std::get<CsvRecord>(read_csv_record(late + "300,47,0.5\n", {}));
    EXPECT_EQ(read.y.front(), 1234);
    EXPECT_EQ(read.y.back(), 0.5);
}

TEST(Csv, TimesWithoutAUnitAreTakenInTheAnswersAndThatIsTold) {
    const auto read = std::get<CsvRecord>(read_csv_record("Time,u,y\n0,1,2\n1,1,3\n", minutes()));
    EXPECT_EQ(read.t.back(), 1);
    EXPECT_THAT(read.notes, Contains(HasSubstr("assumed to be in min")));
}

TEST(TimeStamps, AreReadInManySpellings) {
    const double noon = 1795262400;  // date -u -d "2026-11-21 12:00" +%s
    for (const char* text :
         {"2026-11-21T12:00:00Z", "20261121T120000", "20261121120000", "20261121120000.000", "21.11.2026 12:00:00",
          "21.11.26 12:00", "11/21/2026 12:00 PM", "21/11/2026 12:00:00.000", "21-Nov-2026 12:00:00",
          "21-NOV-26 12:00:00.0", "Nov 21, 2026 12:00:00 PM", "November 21, 2026, 12:00 p.m.",
          "21. November 2026 12:00", "Sat, 21 Nov 2026 12:00:00 GMT", "2026/11/21 12:00:00:000",
          "2026-11-21 13:00:00+01:00", "21 nov. 2026 12:00"}) {
        const auto stamp = read_time_stamp(text);
        ASSERT_TRUE(stamp) << text;
        EXPECT_DOUBLE_EQ(stamp->seconds, noon) << text;
    }
    for (const char* text : {"20261321120000", "20261121250000", "19001121120000", "2026112112000", "202611211200000"})
        EXPECT_FALSE(read_time_stamp(text)) << text;
    EXPECT_DOUBLE_EQ(read_time_stamp("05-Dez-26 00:00")->seconds, noon + 13.5 * 86400);
}

}  // namespace
}  // namespace tunewright::api
