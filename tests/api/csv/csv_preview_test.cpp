// The preview of a file shows what the record reader will do. Files in the formats of loggers.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "api/csv/preview.h"
#include "api/json/json.h"
#include "api/service.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

std::string number(double value, char decimal = '.') {
    std::string out = std::to_string(value).substr(0, std::to_string(value).find('.') + 3);
    std::replace(out.begin(), out.end(), '.', decimal);
    return out;
}

double u_at(int i) { return i < 10 ? 20 : 50; }
double y_at(int i) { return i < 12 ? 20 : 20 + 15 * -std::expm1(-(i - 12) / 8.0); }

/// 60 rows made by `row(i)` below `head`.
std::string file(const std::string& head, const std::function<std::string(int)>& row, const std::string& tail = "") {
    std::string out = head;
    for (int i = 0; i < 60; ++i) out += row(i) + "\n";
    return out + tail;
}

std::string two(int value) { return (value < 10 ? "0" : "") + std::to_string(value); }
std::string clock_text(int i) { return two(14) + ":" + two(3 + i / 12) + ":" + two(5 * (i % 12)); }

std::string row(int i, const char* separator, char decimal, double scale = 1) {
    return number(i * scale, decimal) + separator + number(u_at(i), decimal) + separator + number(y_at(i), decimal);
}

std::vector<std::string> guesses(const CsvPreview& preview) {
    std::vector<std::string> out;
    for (const PreviewColumn& column : preview.columns) out.push_back(column.guess);
    return out;
}

struct File {
    const char* name;
    std::string text;
    double dt = 1;  ///< seconds
    const char* separator = ",";
    const char* decimal = ".";
    int rows = 60;
    const char* encoding = "utf-8";
};

void PrintTo(const File& item, std::ostream* out) { *out << item.name; }

class Previews : public testing::TestWithParam<File> {};

TEST_P(Previews, TellWhatIsRead) {
    const File& item = GetParam();
    const CsvPreview preview = preview_csv(item.text, {});
    ASSERT_THAT(preview.problems, IsEmpty()) << preview.problems.front().message;
    EXPECT_THAT(guesses(preview), Contains("t"));
    EXPECT_THAT(guesses(preview), Contains("u"));
    EXPECT_THAT(guesses(preview), Contains("y"));
    EXPECT_EQ(preview.separator, item.separator);
    EXPECT_EQ(preview.decimal, item.decimal);
    EXPECT_EQ(preview.encoding, item.encoding);
    EXPECT_EQ(preview.rows, item.rows);
    ASSERT_TRUE(preview.time);
    EXPECT_EQ(preview.time->unit, "s");
    EXPECT_NEAR(preview.time->dt, item.dt, 1e-9);
    EXPECT_NEAR(preview.time->to - preview.time->from, 59 * item.dt, 1e-6);
    for (const PreviewColumn& column : preview.columns) {
        if (column.guess != "u" && column.guess != "y") continue;
        EXPECT_EQ(column.min, 20);
        EXPECT_NEAR(*column.max, column.guess == "u" ? 50 : 35, 0.2);
        EXPECT_THAT(column.thumbnail, SizeIs(testing::Ge(60U)));
    }
    const auto read = read_csv_record(item.text, {});
    ASSERT_TRUE(std::holds_alternative<CsvRecord>(read));
    EXPECT_EQ(std::get<CsvRecord>(read).t.size(), 60U);
}

std::string in_utf16(const std::string& ascii, bool big) {
    std::string out = big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : ascii) {
        if (big) out += '\0';
        out += c;
        if (!big) out += '\0';
    }
    return out;
}

std::string labview() {
    return file(
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n"
        "Multi_Headings\tNo\nX_Columns\tOne\nTime_Pref\tRelative\nDate\t2026/11/23\nTime\t14:03:05.1\n"
        "***End_of_Header***\t\t\t\nChannels\t2\t\t\nSamples\t60\t60\t\nDate\t2026/11/23\t2026/11/23\t\n"
        "X_Dimension\tTime\tTime\t\nX0\t0.0E+0\t0.0E+0\t\nDelta_X\t1.0\t1.0\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tHeater output\tTemperature\tComment\n",
        [](int i) { return row(i, "\t", '.'); });
}

const File kFiles[] = {
    {"plain", file("t,u,y\n", [](int i) { return row(i, ",", '.'); })},
    {"decimal comma", file("Zeit;Stellgröße;Temperatur\n", [](int i) { return row(i, ";", ','); }), 1, ";", ","},
    {"excel's sep", file("sep=;\nTime;OP;PV\n", [](int i) { return row(i, ";", ','); }), 1, ";", ","},
    {"german dates",
     file(
         "Datum Uhrzeit;OP;PV\n",
         [](int i) { return "23.11.2026 " + clock_text(i) + ";" + number(u_at(i), ',') + ";" + number(y_at(i), ','); }),
     5, ";", ","},
    {"iso stamps",
     file("timestamp,output,temperature\n",
          [](int i) { return "2026-11-23T" + clock_text(i) + "Z," + number(u_at(i)) + "," + number(y_at(i)); }),
     5},
    {"tabs", file("time\tu\ty\n", [](int i) { return row(i, "\t", '.'); }), 1, "tab"},
    {"quoted cells", file("\"Time\",\"OP\",\"PV\"\n", [](int i) { return "\"" + row(i, "\",\"", '.') + "\""; })},
    {"units below", file("Time,OP,PV\n[s],[%],[degC]\n", [](int i) { return row(i, ",", '.'); })},
    {"minutes below", file("Time,OP,PV\nmin,%,degC\n", [](int i) { return row(i, ",", '.'); }), 60},
    {"totals at the end",
     file(
         "Time;OP;PV\n", [](int i) { return row(i, ";", ','); }, "Total;;1823,4\n"),
     1, ";", ",", 61},
    {"millis", file("millis,pwm,temp\n", [](int i) { return row(i, ",", '.', 250); }), 0.25},
    {"Elapsed [msec]", file("Elapsed [msec],Output,Temp\n", [](int i) { return row(i, ",", '.', 250); }), 0.25},
    {"time ms", file("Time (ms);Heater;Temperature\n", [](int i) { return row(i, ";", ',', 100); }), 0.1, ";", ","},
    {"minutes", file("Time [min],OP,PV\n", [](int i) { return row(i, ",", '.', 0.5); }), 30},
    {"hours", file("Time (h),OP,PV\n", [](int i) { return row(i, ",", '.', 0.25); }), 900},
    {"sec", file("sec,valve,level\n", [](int i) { return row(i, ",", '.', 2); }), 2},
    {"epoch in ms",
     file("time,output,temp\n",
          [](int i) {
              return std::to_string(1795442585000 + 500LL * i) + "," + number(u_at(i)) + "," + number(y_at(i));
          }),
     0.5},
    {"thousands",
     file("Time;OP;PV\n",
          [](int i) { return "1.0" + two(i) + ",0;" + number(u_at(i), ',') + ";" + number(y_at(i), ','); }),
     1, ";", ","},
    {"cp1252",
     file("Zeit [s];Stellgr\xF6\xDF"
          "e [%];Temperatur [\xB0"
          "C]\n",
          [](int i) { return row(i, ";", ','); }),
     1, ";", ",", 60, "iso-8859-1"},
    {"cp1252 with a dash",
     file("Zeit [s];Stellgr\xF6\xDF"
          "e \x96 Ventil [%];Temperatur [\xB0"
          "C]\n",
          [](int i) { return row(i, ";", ','); }),
     1, ";", ",", 60, "windows-1252"},
    {"utf-16 little", in_utf16(file("Time\tOP\tPV\r\n", [](int i) { return row(i, "\t", '.'); }), false), 1, "tab", ".",
     60, "utf-16le"},
    {"utf-16 big", in_utf16(file("Time\tOP\tPV\r\n", [](int i) { return row(i, "\t", '.'); }), true), 1, "tab", ".", 60,
     "utf-16be"},
    {"byte order mark", "\xEF\xBB\xBF" + file("Time,OP,PV\n", [](int i) { return row(i, ",", '.'); })},
    {"LabVIEW", labview(), 1, "tab"},
    {"garbage of a serial port",
     file("t,u,y\n",
          [](int i) {
              return i == 31 ? "22.1,4\xEF\xBF\xBD"
                               "5;;,\n" +
                                   row(i, ",", '.')
                             : row(i, ",", '.');
          }),
     1, ",", ".", 61},
    {"AVEVA with quality",
     file("DateTime,TIC101.OP,OP Quality,TIC101.PV,PV Quality\n",
          [](int i) {
              return "2026-11-23 " + clock_text(i) + ".000," + number(u_at(i)) + ",192," + number(y_at(i)) + ",192";
          }),
     5},
    {"Siemens trend",
     file("\"TimeString\";\"Ventil_Y\";\"Temp_Ist\";\"Temp_Soll\"\n",
          [](int i) {
              return "\"23.11.2026 " + clock_text(i) + "\";" + number(u_at(i), ',') + ";" + number(y_at(i), ',') +
                     ";40,0";
          }),
     5, ";", ","},
    {"Rockwell",
     file("Date,Time,TIC101.CV,TIC101.PV,TIC101.SP\n",
          [](int i) { return "11/23/2026," + clock_text(i) + "," + number(u_at(i)) + "," + number(y_at(i)) + ",40"; }),
     5},
    {"Ignition",
     file("t_stamp,Loop/OP,Loop/PV\n",
          [](int i) { return "2026-11-23 " + clock_text(i) + "," + number(u_at(i)) + "," + number(y_at(i)); }),
     5},
    {"Grafana",
     file(
         "\"Time\",\"heater power\",\"boiler temperature\"\n",
         [](int i) { return "2026-11-23 " + clock_text(i) + "," + number(u_at(i)) + " %," + number(y_at(i)) + " °C"; }),
     5},
};

INSTANTIATE_TEST_SUITE_P(Files, Previews, testing::ValuesIn(kFiles), [](const auto& tested) {
    std::string name = tested.param.name;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
});

TEST(Preview, ASerialLogOfNamedValuesIsAskedForItsSamplingTime) {
    const std::string log =
        file("boot\n", [](int i) { return "T:" + number(y_at(i)) + " S:40 PWM:" + number(u_at(i)); });
    const CsvPreview asked = preview_csv(log, {});
    EXPECT_EQ(asked.separator, "pairs");
    ASSERT_THAT(asked.problems, SizeIs(1));
    EXPECT_EQ(asked.problems.front().where, "columns/t");
    EXPECT_THAT(asked.problems.front().message,
                HasSubstr("No time column found. Choose one or enter the sampling time."));
    CsvOptions options;
    options.dt = 0.5;
    const CsvPreview given = preview_csv(log, options);
    EXPECT_THAT(given.problems, IsEmpty());
    EXPECT_EQ(given.time->dt, 0.5);
}

TEST(Preview, AFileWithoutHeadingsShowsItsColumnsAndAsksWhich) {
    const std::string text = file("", [](int i) { return number(u_at(i) + i % 3) + ";" + number(y_at(i) + i % 2); });
    const CsvPreview preview = preview_csv(text, {});
    ASSERT_THAT(preview.columns, SizeIs(2));
    EXPECT_EQ(preview.columns[0].heading, "");
    EXPECT_EQ(preview.columns[1].first, "20.00");
    EXPECT_FALSE(preview.time);
    std::vector<std::string> where;
    for (const CsvFault& problem : preview.problems) {
        where.push_back(problem.where);
        EXPECT_THAT(problem.message, Not(HasSubstr("columns.")));
    }
    EXPECT_THAT(where, ElementsAre("columns/t", "columns/u", "columns/y"));
    CsvOptions options;
    options.columns.u = 1;
    options.columns.y = 2;
    options.dt = 2;
    const CsvPreview chosen = preview_csv(text, options);
    EXPECT_THAT(chosen.problems, IsEmpty());
    EXPECT_THAT(guesses(chosen), ElementsAre("u", "y"));
    EXPECT_EQ(chosen.columns[0].confidence, 1);
    EXPECT_EQ(chosen.time->dt, 2);
}

TEST(Preview, SaysWhatWasPassedOverAndWhatTheTimesLack) {
    const CsvPreview preview = preview_csv(file(
                                               "Trend of TIC101\nTime,OP,PV\ns,%,degC\n",
                                               [](int i) {
                                                   return row(i < 30 ? i : i == 30 ? 29 : i + 20, ",", '.');
                                               },
                                               ",,\nTotal,,1823.4\n"),
                                           {});
    ASSERT_THAT(preview.problems, IsEmpty());
    std::vector<std::pair<int, std::string>> skipped;
    for (const CsvSkip& skip : preview.skipped) skipped.emplace_back(skip.line, skip.reason);
    EXPECT_THAT(skipped,
                ElementsAre(std::pair(1, "above the headings"), std::pair(3, "units or descriptions, no numbers"),
                            std::pair(64, "no time"), std::pair(65, "column \"Time\": \"Total\" is not a number.")));
    EXPECT_EQ(preview.time->gaps, 1);
    EXPECT_EQ(preview.time->duplicates, 1);
    EXPECT_EQ(preview.skipped_lines, 2);
    EXPECT_THAT(preview.notes, Contains(HasSubstr("could not be read and was left out: Line 65")));
}

TEST(Preview, ManyUnreadableLinesAreNoAccident) {
    const CsvPreview preview =
        preview_csv(file("t,u,y\n", [](int i) { return i % 20 == 7 ? number(i) + ",20,bump" : row(i, ",", '.'); }), {});
    ASSERT_THAT(preview.problems, SizeIs(3));
    EXPECT_THAT(preview.problems.front().message, HasSubstr("Line 9, column \"y\": \"bump\" is not a number."));
}

TEST(Preview, AUnitThatNothingNamesIsSaidToBeAssumedAndCanBeGiven) {
    const std::string text = file("t,u,y\n", [](int i) { return row(i, ",", '.', 250); });
    EXPECT_TRUE(preview_csv(text, {}).time->assumed);
    CsvOptions options;
    options.file_time_unit = "ms";
    const CsvPreview given = preview_csv(text, options);
    EXPECT_FALSE(given.time->assumed);
    EXPECT_NEAR(given.time->dt, 0.25, 1e-12);
}

TEST(Preview, ThumbnailsOfLongColumnsKeepTheirExtremes) {
    std::string text = "t,u,y\n";
    for (int i = 0; i < 20'000; ++i)
        text += std::to_string(i) + (i < 500 ? ",0," : ",1,") + (i == 12'345 ? "99" : std::to_string(i % 7)) + "\n";
    const CsvPreview preview = preview_csv(text, {});
    EXPECT_EQ(preview.rows, 20'000);
    const std::vector<double>& y = preview.columns[2].thumbnail;
    EXPECT_LE(y.size(), 240U);
    EXPECT_GE(y.size(), 120U);
    EXPECT_THAT(y, Contains(99));
    EXPECT_EQ(preview.columns[2].max, 99);
}

TEST(Preview, AnEmptyFileAndProseHaveProblemsAndNoColumns) {
    for (const char* text : {"", "The valve was opened at noon.\nThen it was closed.\n"}) {
        const CsvPreview preview = preview_csv(text, {});
        EXPECT_THAT(preview.columns, IsEmpty());
        ASSERT_THAT(preview.problems, SizeIs(1));
        EXPECT_EQ(preview.problems.front().where, "csv");
    }
}

TEST(Preview, IsAnsweredAsJson) {
    const Answer answer = preview_file(file("Time,OP,PV\n", [](int i) { return row(i, ",", '.'); }));
    EXPECT_EQ(answer.status, 200);
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(body["columns"][1]["heading"], "OP");
    EXPECT_EQ(body["columns"][1]["guess"], "u");
    EXPECT_EQ(body["rows"], 60);
    EXPECT_EQ(body["encoding"], "utf-8");
    EXPECT_EQ(body["time"]["dt"], 1);
    EXPECT_EQ(preview_call(R"({"csv": "t,u,y\n0,0,0\n1,1,1\n", "time_unit": "fortnight"})").status, 422);
    EXPECT_EQ(preview_call("{}").status, 422);
    const Json minutes = Json::parse(preview_call(R"({"csv": "t,u,y\n0,0,0\n1,1,1\n", "time_unit": "min"})").body);
    EXPECT_EQ(minutes["time"]["dt"], 60);
}

TEST(Identify, TimesInMillisecondsThatNothingNamesAreAskedFor) {
    std::string text = "t,u,y\n";
    for (int i = 0; i < 400; ++i) {
        const double y = i < 25 ? 20 : 20 + 10 * -std::expm1(-(i - 25) / 60.0);
        text += std::to_string(4000 * i) + "," + (i < 20 ? "0" : "5") + "," + std::to_string(y + 0.01 * (i % 3)) + "\n";
    }
    const auto warnings = [](const Json& request) {
        const Json answer = Json::parse(identify_call(request.dump(), {}).body);
        std::string codes;
        for (const Json& warning : answer["model"]["warnings"]) codes += warning["code"].get<std::string>() + " ";
        return codes;
    };
    Json request{{"record", {{"csv", text}}}};
    EXPECT_THAT(warnings(request), HasSubstr("time-unit-doubtful"));
    request["record"]["time_unit"] = "ms";
    EXPECT_THAT(warnings(request), Not(HasSubstr("time-unit-doubtful")));
}

}  // namespace
}  // namespace tunewright::api
