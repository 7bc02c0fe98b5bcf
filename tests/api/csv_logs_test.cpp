// Records as loggers, printers, controllers and other people's scripts write them: read right, or refused with the
// cure.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>

#include "api/csv/record.h"
#include "support.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// One sample of the same simulated test in every format: u from 20 to 50 at the tenth, y answers by a lag of 12 s.
struct Sample {
    int t;
    double u, y;
};

constexpr int kSamples = 60;

std::vector<Sample> samples() {
    std::vector<Sample> out;
    double y = 20;
    for (int t = 0; t < kSamples; ++t) {
        const double u = t < 10 ? 20 : 50;
        out.push_back({t, u, std::round(100 * y) / 100});
        y += (20 + 0.5 * (u - 20) - y) / 12;
    }
    return out;
}

std::string digits(double value, int decimals = 2) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
    return buffer;
}

std::string clock(int t) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "14:%02d:%02d", 5 + t / 60, t % 60);
    return buffer;
}

const char* on_off(double u) { return u > 30 ? "ON" : "OFF"; }

std::string rows(const std::function<std::string(const Sample&)>& row) {
    std::string out;
    for (const Sample& sample : samples()) out += row(sample) + "\n";
    return out;
}

/// "{t},{u},{y}" with the sample's figures; {ms} milliseconds, {clock} the time of day, {on} ON or OFF, {duty} u/100.
std::string written(const std::string& form) {
    return rows([&](const Sample& s) {
        std::string line = form;
        const std::pair<const char*, std::string> figures[] = {
            {"{t}", std::to_string(s.t)},       {"{ms}", std::to_string(1000 * s.t)},
            {"{row}", std::to_string(s.t + 1)}, {"{clock}", clock(s.t)},
            {"{late}", clock(2 * s.t)},         {"{u}", digits(s.u, 0)},
            {"{duty}", digits(s.u / 100, 3)},   {"{y}", digits(s.y)},
            {"{e}", digits(40 - s.y)},          {"{on}", on_off(s.u)}};
        for (const auto& [name, text] : figures) {
            for (std::size_t at = line.find(name); at != line.npos; at = line.find(name))
                line.replace(at, std::string(name).size(), text);
        }
        return line;
    });
}

std::string with_commas(std::string text) {
    for (char& c : text) c = c == '.' ? ',' : c;
    return text;
}

CsvOptions seconds(double dt) {
    CsvOptions options;
    options.dt = dt;
    return options;
}

struct Log {
    const char* name;
    std::string text;
    double u_scale = 1;          ///< of 20 and 50
    double u_low = 20;           ///< else, of a log that switches, 0
    double r = std::nan("");     ///< the set point, where there is one
    const char* note = nullptr;  ///< part of a sentence that must come back
    CsvOptions options = {};
};

void PrintTo(const Log& item, std::ostream* out) { *out << item.name; }

class Logs : public testing::TestWithParam<Log> {};

TEST_P(Logs, AreReadRight) {
    const Log& item = GetParam();
    const auto out = read_csv_record(item.text, item.options);
    if (const auto* faults = std::get_if<std::vector<CsvFault>>(&out))
        FAIL() << faults->front().where << ": " << faults->front().message;
    const auto& record = std::get<CsvRecord>(out);
    const std::vector<Sample> expected = samples();
    ASSERT_EQ(record.t.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double high = item.u_low == 0 ? 1 : 50 * item.u_scale;
        ASSERT_NEAR(record.t[i] - record.t[0], expected[i].t, 1e-6) << i;
        ASSERT_NEAR(record.u[i], expected[i].u > 30 ? high : item.u_low * item.u_scale, 1e-9) << i;
        ASSERT_NEAR(record.y[i], expected[i].y, 0.05 + 1e-9) << i;
    }
    EXPECT_EQ(record.r, std::vector<double>(std::isnan(item.r) ? 0 : expected.size(), item.r));
    if (item.note) {
        EXPECT_THAT(record.notes, Contains(HasSubstr(item.note)));
    }
}

const double kNone = std::nan("");

// The clock of Klipper counts seconds since its start.
std::string klipper(const std::string& heaters) {
    std::string out = "Starting Klippy...\n[extruder]\npid_kp = 22.2\nmesh = 0.1, 0.2, 0.3\n";
    for (const Sample& s : samples()) {
        std::string line = "Stats " + digits(12345.6 + s.t, 1) +
                           ": gcodein=0  mcu: mcu_awake=0.002 mcu_task_avg=0.000005 freq=180000000 " + heaters;
        for (const auto& [name, text] : {std::pair{"{y}", digits(s.y)}, {"{duty}", digits(s.u / 100, 3)}}) {
            if (const std::size_t at = line.find(name); at != line.npos) line.replace(at, std::strlen(name), text);
        }
        out += line + " sysload=0.35 print_time=" + digits(s.t, 3) + "\n";
    }
    return out + "Reactor garbage collection: (1, 2, 3)\n";
}

const std::vector<Log> kLogs = {
    {"headings_without_values",
     "time,setpoint,temp,error,P,I,D,output,Kp,Ki,Kd,mode,comment\n" + written("{t},40,{y},{e},1,2,3,{u}"), 1, 20, 40,
     "Line 1 has 13 headings and the rows have 8 values: they are read as those of the first 8 headings"},
    {"rows_that_end_early", "time,temp,output,Kp,Ki,comment\n0,20.00,20,1,2,start\n" +
                                written("{t},{y},{u}").substr(std::string("0,20.00,20\n").size())},
    {"commented_headings", "# time, u, y\n" + written("{t}, {u}, {y}"), 1, 20, kNone,
     "The headings are those of the comment in line 1."},
    {"commented_headings_over_blanks", "# logged by me\n# time, y, u\n" + written("{t} {y} {u}")},
    {"matlab_comment", "% t y u\n" + written("{t} {y} {u}")},
    {"on_and_off", "time,heater,temp\n" + written("{t},{on},{y}"), 1, 0, kNone,
     "u is two levels: \"OFF\" is 0 and \"ON\" is 1."},
    {"state_of_the_heater", "time;heater state;temp\n" + written("{t};{on};{y}"), 1, 0},
    {"unnamed_switch", "time,K1,temp\n" + written("{t},{on},{y}"), 1, 0, kNone,
     "is read as u, the controller output (it switches)"},
    {"trailing_commas", "time,u,y\n" + written("{t},{u},{y},")},
    {"trailing_commas_in_the_headings_too", "time,u,y,\n" + written("{t},{u},{y},")},
    {"trailing_commas_without_headings", written("{t},{u},{y},")},
    {"columns_of_blanks_without_headings", written("   {t}   {u}   {y}")},
    {"klipper", klipper("heater_bed: target=60 temp={y} pwm={duty} extruder: target=0 temp=25.1 pwm=0.000"), 0.01, 20,
     60, "\"extruder.pwm\" does not move and was passed over."},
    {"pairs_with_colons", written("time: {t} temp: {y} pwm: {duty} target: 60"), 0.01, 20, 60},
    {"pairs_with_equals", written("time={t} temp={y} pwm={duty} target=60"), 0.01, 20, 60},
    {"pairs_with_units",
     written("[{clock}] Temp: {y} \xC2\xB0"
             "C, Heater: {u} %, Target: 60.0 \xC2\xB0"
             "C"),
     1, 20, 60},
    {"pairs_with_decimal_commas", with_commas(written("t={t};temp={y};pwm={u}"))},
    {"pairs_that_switch", written("[{clock}] temp={y} heater={on}"), 1, 0},
    {"serial_plotter_with_clock", written("{clock}.123 -> T:{y},PWM:{u}")},
    {"serial_plotter", written("T:{y},PWM:{u}"), 1, 20, kNone, nullptr, seconds(1)},
    {"serial_plotter_of_a_controller", written("Setpoint:40,Input:{y},Output:{u}"), 1, 20, 40,
     "as the controller calls it: the file has a set point", seconds(1)},
    {"octoprint", written("2026-11-21 {clock},123 - Recv: ok T:{y} /200.0 B:60.1 /60.0 T0:{y} /200.0 @:{u} B@:30"), 1,
     20, 200},
    {"marlin", written(" T:{y} /200.0 B:60 /60 @:{u} B@:30"), 1, 20, 200, nullptr, seconds(1)},
    {"json_lines", written(R"({"t": {t}, "u": {u}, "y": {y}})")},
    {"json_lines_with_stamps", written(R"({"ts": "2026-11-21T{clock}Z", "temp": {y}, "heater": "{on}"})"), 1, 0},
    {"python_dictionaries", written("{'time': {t}, 'temp': {y}, 'pwm': {u}}")},
    {"measured_speed", "time,speed,measured_speed,pwm\n" + written("{t},40,{y},{u}")},
    {"measured_speed_beside_its_moving_command", "time,speed,measured_speed,pwm\n" + written("{t},{e},{y},{u}"), 1, 20,
     kNone, "Column \"measured_speed\" is read as y, the measurement, as the measured one; it may also be \"speed\""},
    {"actual_speed", "t(s),Speed,Actual Speed,Output\n" + written("{t},40,{y},{u}")},
    {"target_and_measured", "time_ms,target_rpm,measured_rpm,pwm\n" + written("{ms},40,{y},{u}"), 1, 20, 40},
    {"two_data_sets",
     "\"uEst\",\"uVal\",\"yEst\",\"yVal\",\"Ts\",\n" +
         [] {
             std::string text = written("{u},1,{y},2,,");
             return text.replace(text.find(",,"), 2, ",1,");
         }(),
     1, 20, kNone, "The file holds a second pair, \"uVal\" and \"yVal\"; columns.u and columns.y choose it."},
    {"spacing_in_every_row", "dt,u,y\n" + written("1,{u},{y}"), 1, 20, kNone, "Times are made from column \"dt\""},
    {"german_letters", with_commas("Zeit;W;X;Y\n" + written("{t};40;{y};{u}")), 1, 20, 40, "as in DIN 19226"},
    {"german_words", "Datum;Uhrzeit;Sollwert;Istwert;Stellwert\n" + written("21/11/2026;{clock};40;{y};{u}"), 1, 20,
     40},
    {"two_clocks_that_agree", "PV Time,PV,OP Time,OP\n" + written("{clock},{y},{clock},{u}")},
    {"grafana_wide", "\"Time\",\"temp\",\"heater\"\n" + written("2026-11-21 {clock},{y},{u}")},
    {"title_and_units", "Test run 5,,,\n,,,\nTime,Valve,Temp,Remark\n[s],[%],[degC],\n" + written("{t},{u},{y},")},
    {"influx_annotated",
     "#group,false,false,true\n#datatype,string,long,dateTime:RFC3339,double,double\n#default,mean,,,,\n"
     ",result,table,_time,temp,pwm\n" +
         written(",,0,2026-11-21T{clock}Z,{y},{u}")},
    {"tia_trace",
     "Trace;Trace_1\nDevice;PLC_1\n\nSample;Time [ms];PID.Setpoint;PID.Input;PID.Output\n" +
         written("{row};{ms};40;{y};{u}"),
     1, 20, 40},
    {"factorytalk",
     "\"Trend: TIC101\",\"\",\"\"\n\"Date\",\"Time\",\"Millitm\",\"TIC101\\PV\",\"TIC101\\SP\",\"TIC101\\CV\"\n" +
         written("\"11/21/2026\",\"{clock}\",\"000\",{y},40,{u}"),
     1, 20, 40},
    {"yokogawa",
     "Data,TIC101\nChannel,CH001,CH002,CH003\nTag,PV,SV,MV\nUnit,degC,degC,%\n" +
         written("2026/11/21 {clock},{y},40.0,{u}"),
     1, 20, 40},
    {"honeywell",
     "Date/Time,TIC101.PV,TIC101.SP,TIC101.OP,TIC101.MODE\n" + written("11/21/2026 {clock},{y},40,{u},MAN"), 1, 20, 40},
    {"data_logger_brackets",
     "Scan,Time,101 <PV> (C),102 <OUT> (VDC)\n" + written("{row},11/21/2026 {clock}:120,{y},{u}")},
    {"thermostat",
     "Time,Setpoint Temp,Room Temp,Outside Temp,Heating\n" + written("2026-11-21 {clock},21,{y},5.0,{on}"), 1, 0, 21},
    {"camel_case", "timeMs,setPoint,processValue,controllerOutput\n" + written("{ms},40,{y},{u}"), 1, 20, 40},
    {"milliseconds_of_a_board", "millis,temp,pwm\n" + written("{ms},{y},{u}")},
    {"a_capital_t_is_a_temperature", "Time,T,Q\n" + written("{t},{y},{u}")},
    {"r_table", "\"t\" \"u\" \"y\"\n" + written("\"{row}\" {t} {u} {y}"), 1, 20, kNone, "numbers the rows"},
    {"terms_of_the_controller", "t,r,y,e,P,I,D,u\n" + written("{t},40,{y},{e},1,2,3,{u}"), 1, 20, 40,
     "The controller's own terms are in the file, \"e\", \"P\", \"I\" and \"D\"; they are passed over."},
    {"a_command_that_is_u", "time,cmd,rpm\n" + written("{t},{u},{y}"), 1, 20, kNone, "no other column is"},
    {"a_command_beside_u", "time,cmd,rpm,pwm\n" + written("{t},40,{y},{u}"), 1, 20, 40},
    {"set_point_of_the_same_tag", "Time,TIC101.PV,TIC101.SP,TIC101.OP,TIC102.SP\n" + written("{t},{y},40,{u},50"), 1,
     20, 40},
    {"plant_input_and_output", "time,input,output\n" + written("{t},{u},{y}")},
    {"board_log", written("I ({ms}) pid: temp: {y}, output: {u}, setpoint: 40"), 1, 20, 40},
    {"two_heaters_by_number",
     "Time,Heater 1,Heater 2,Temperature 1,Temperature 2,Set Point 1,Set Point 2\n" + written("{t},{u},0,{y},{e},40,0"),
     1, 20, 40, "\"Heater 2\" does not move and was passed over."},
    {"drawn_table",
     "+----+----+----+\n| time | u | y |\n+----+----+----+\n" + written("| {t} | {u} | {y} |") + "+----+----+----+\n"},
    {"markdown_table", "| time | u | y |\n|---|---|---|\n" + written("| {t} | {u} | {y} |")},
};

INSTANTIATE_TEST_SUITE_P(Csv, Logs, testing::ValuesIn(kLogs),
                         [](const auto& one) { return std::string(one.param.name); });

std::string told(const std::string& text, const CsvOptions& options = {}) {
    const auto out = read_csv_record(text, options);
    const auto* faults = std::get_if<std::vector<CsvFault>>(&out);
    return faults ? faults->front().where + ": " + faults->front().message : "it was read";
}

TEST(Csv, HeadingsThatNothingTellsApartAreShownBesideTheValues) {
    EXPECT_THAT(
        told("a,b,c,d,e\n" + written("{t},{y},{u}")),
        HasSubstr("csv: Line 1 has 5 headings and the rows have 3 values, so which belongs to which is open: "
                  "headings \"a\", \"b\", \"c\", \"d\" and \"e\"; values \"0\", \"20.00\" and \"20\". Give each "
                  "column one heading."));
}

TEST(Csv, AHeadingOfTimeOverNumbersThatDoNotRunMakesSurplusHeadingsOpen) {
    EXPECT_THAT(told("temp,time,u,x,z\n" + written("{t},{y},{u}")), HasSubstr("so which belongs to which is open"));
}

TEST(Csv, TwoClocksAreRefusedWithTheCure) {
    EXPECT_THAT(
        told("PV Time,PV,OP Time,OP\n" + written("{clock},{y},{late},{u}")),
        HasSubstr("csv has two clocks: \"OP\" has its own times in \"OP Time\", which are not those of \"PV Time\". "
                  "Export all tags at common times"));
}

TEST(Csv, SeveralHeatersThatAreDrivenAreNotGuessedAmong) {
    const std::string both =
        klipper("heater_bed: target=60 temp={y} pwm={duty} extruder: target=200 temp=199.5 pwm=0.5");
    std::string moving = both;
    moving.replace(moving.find("pwm=0.5"), 7, "pwm=0.4");
    moving.replace(moving.find("temp=199.5"), 10, "temp=199.7");
    EXPECT_THAT(told(moving),
                HasSubstr("columns/u: Several columns may be u (the controller output): \"heater_bed.pwm\" and "
                          "\"extruder.pwm\". Name one in columns.u."));
    CsvOptions options;
    options.columns.y = "heater_bed.temp";
    const auto chosen = std::get<CsvRecord>(read_csv_record(moving, options));
    EXPECT_EQ(chosen.u.back(), 0.5);
    EXPECT_EQ(chosen.r.back(), 60);
    EXPECT_NEAR(chosen.y.back(), samples().back().y, 0.01);
}

TEST(Csv, LinesOfOneTagEachAreRefusedInEveryDialect) {
    const std::string cure = "export it with one column for each tag";
    EXPECT_THAT(told("\"Time\",\"Series\",\"Value\"\n2026-11-21 14:00:00,temp,20\n2026-11-21 14:00:00,pwm,30\n"),
                HasSubstr(cure));
    EXPECT_THAT(told("entity_id,state,last_changed\nsensor.temp,20,2026-11-21T14:00:00Z\nsensor.power,30,2026-11-21T14:"
                     "00:00Z\n"),
                HasSubstr(cure));
    EXPECT_THAT(
        told(",result,table,_time,_value,_field\n,,0,2026-11-21T14:00:00Z,20,temp\n,,1,2026-11-21T14:00:00Z,30,pwm\n"),
        HasSubstr(cure));
}

TEST(Csv, ALogOfSentencesIsRefusedByItsFirstLine) {
    EXPECT_THAT(
        told(written("[{clock}][D][sensor:094]: 'Boiler': Sending state {y} \xC2\xB0"
                     "C with 1 decimals")),
        HasSubstr("csv has no line of numbers in columns, nor lines that name two values or more each; it begins with "
                  "\"[14:05:00][D][sensor:094]"));
}

TEST(Csv, ALogWithoutTimesAsksForTheirSpacing) {
    EXPECT_THAT(told(written("T:{y},PWM:{u}")),
                HasSubstr("columns/t: No heading is plainly t (time); name it in columns.t, or give dt."));
}

TEST(Csv, ASetPointIsNeitherUNorY) {
    for (const char* name :
         {"SP", "setpoint", "set point", "Set_Point", "target", "Sollwert", "consigne", "reference", "r", "w",
          "TIC101.SP", "targetTemp", "T_set", "temp target", "rpm_ref", "SV", "desired speed", "pv_sp"}) {
        SCOPED_TRACE(name);
        EXPECT_THAT(told("time," + std::string(name) + ",temp\n" + written("{t},{u},{y}")),
                    HasSubstr("columns/u: No heading is plainly u"));
        EXPECT_THAT(told("time," + std::string(name) + ",valve\n" + written("{t},{y},{u}")),
                    HasSubstr("columns/y: No heading is plainly y"));
        const auto read = read_csv_record("time," + std::string(name) + ",pv,op\n" + written("{t},7,{y},{u}"), {});
        ASSERT_TRUE(std::holds_alternative<CsvRecord>(read));
        EXPECT_EQ(std::get<CsvRecord>(read).r, std::vector<double>(kSamples, 7));
    }
}

TEST(Csv, ASetPointThatIsWrittenWhereItChangesHolds) {
    const auto record = std::get<CsvRecord>(read_csv_record("t,u,y,sp\n0,1,2,\n1,1,3,40\n2,1,4,\n3,1,5,50\n", {}));
    EXPECT_THAT(record.r, ElementsAre(40, 40, 40, 50));
    const auto empty = std::get<CsvRecord>(read_csv_record("t,u,y,sp\n0,1,2,\n1,1,3,\n", {}));
    EXPECT_THAT(empty.r, IsEmpty());
}

TEST(Csv, ASetPointIsChosenLikeAnyColumn) {
    CsvOptions options;
    options.columns.r = "Ramp";
    EXPECT_THAT(std::get<CsvRecord>(read_csv_record("t,u,y,SP,Ramp\n0,1,2,5,6\n1,1,3,5,7\n", options)).r,
                ElementsAre(6, 7));
    options.columns.r = "none";
    EXPECT_THAT(told("t,u,y,SP\n0,1,2,5\n", options), HasSubstr("columns/r: r is \"none\", which is not a heading"));
}

TEST(Csv, InputAndOutputWithoutASetPointAreToldByWhatTheyDo) {
    EXPECT_THAT(
        told("time,input,output\n0,1,2\n1,2,3\n2,3,3.5\n3,3.5,4\n4,5,7\n"),
        HasSubstr("\"input\" and \"output\" may be the plant's or the controller's, and the numbers do not tell."));
}

TEST(Csv, WordsBesideNumbersAreNoLevels) {
    EXPECT_THAT(told("t,u,y\n0,50,2\n1,OFF,3\n"), HasSubstr("Line 3, column \"u\": \"OFF\" is not a number."));
    EXPECT_THAT(told("t,u,y\n0,50,ON\n1,51,OFF\n"), HasSubstr("is not a number."));
}

TEST(Csv, AClockOfTwoPartsIsSaidToBeHoursAndMinutes) {
    const auto record = std::get<CsvRecord>(read_csv_record("time,u,y\n00:05,1,2\n00:06,1,3\n", {}));
    EXPECT_THAT(record.t, ElementsAre(0, 60));
    EXPECT_THAT(record.notes, Contains(HasSubstr("\"00:05\" are read as hours and minutes")));
}

TEST(Csv, RemarksThatNameSettingsMakeNoLogOfPairs) {
    const auto read = read_csv_record("time,valve,temp,remark\n" + written("{t},{u},{y},Kp=1 Ki=2 Kd=0"), {});
    ASSERT_TRUE(std::holds_alternative<CsvRecord>(read));
    EXPECT_EQ(std::get<CsvRecord>(read).u.back(), 50);
    EXPECT_NEAR(std::get<CsvRecord>(read).y.back(), samples().back().y, 0.01);
}

TEST(Csv, TimesOfNoUnitThatAreFarApartAreRemarked) {
    const auto notes = [](const CsvOptions& options) {
        return std::get<CsvRecord>(read_csv_record("t,u,y\n0,1,2\n20,1,3\n40,1,3\n", options)).notes;
    };
    EXPECT_THAT(notes({}),
                Contains(HasSubstr("The file tells no unit of time: the times are read as s, 20 or more apart.")));
    CsvOptions told;
    told.time_unit_given = true;
    EXPECT_THAT(notes(told), IsEmpty());
}

TEST(Csv, PlainTablesGetNoRemarks) {
    EXPECT_THAT(std::get<CsvRecord>(read_csv_record("t,u,y\n0,1,2\n1,1,3\n", {})).notes, IsEmpty());
}

// Damaged logs: whatever comes, sentences or finite numbers. Seeded.
TEST(Csv, DamagedLogsAreReadOrRefused) {
    std::mt19937 random(7);
    const auto pick = [&](std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
    };
    const std::vector<std::string> pieces = {"",  ":", "=",  " /", "@",      "\"", "'", "{", "}", "[",    "]",  ",",
                                             ";", "|", "\n", "\t", "Stats ", "#",  "%", "-", "e", "1e99", "ON", "\xFF"};
    for (int i = 0; i < 3000; ++i) {
        std::string text = kLogs[pick(kLogs.size())].text;
        text.resize(std::min<std::size_t>(text.size(), 1500));
        for (std::size_t damage = 0; damage <= pick(6); ++damage) {
            const std::size_t at = pick(text.size()), length = pick(6);
            text.replace(at, std::min(length, text.size() - at), pieces[pick(pieces.size())]);
        }
        const auto read = read_csv_record(text, {});
        if (const auto* faults = std::get_if<std::vector<CsvFault>>(&read)) {
            ASSERT_THAT(*faults, Not(IsEmpty())) << text;
            continue;
        }
        const auto& record = std::get<CsvRecord>(read);
        ASSERT_EQ(record.t.size(), record.y.size());
        ASSERT_TRUE(record.r.empty() || record.r.size() == record.t.size());
        for (const double r : record.r) ASSERT_TRUE(std::isfinite(r)) << text;
        for (const double t : record.t) ASSERT_TRUE(std::isfinite(t)) << text;
    }
}

}  // namespace
}  // namespace tunewright::api
