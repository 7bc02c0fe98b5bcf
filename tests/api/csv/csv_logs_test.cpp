// Logs of loggers, printers, controllers and scripts are read correctly; damaged ones are read or refused.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "api/csv/csv_record.h"
#include "tests/api/csv/written_logs.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

CsvOptions seconds(double dt) {
    CsvOptions options;
    options.dt = dt;
    return options;
}

struct Log {
    const char* name;
    std::string text;
    double u_scale = 1;          ///< for levels 20 and 50
    double u_low = 20;           ///< otherwise, for a log that switches, 0
    double r = std::nan("");     ///< the set point, if there is one
    const char* note = nullptr;  ///< part of a sentence that must be reported
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

const double kUnwritten = std::nan("");

const std::vector<Log> kLogs = {
    {"headings_without_values",
     "time,setpoint,temp,error,P,I,D,output,Kp,Ki,Kd,mode,comment\n" + written("{t},40,{y},{e},1,2,3,{u}"), 1, 20, 40,
     "Line 1 has 13 headings and the rows have 8 values: they are read as those of the first 8 headings"},
    {"rows_that_end_early", "time,temp,output,Kp,Ki,comment\n0,20.00,20,1,2,start\n" +
                                written("{t},{y},{u}").substr(std::string("0,20.00,20\n").size())},
    {"commented_headings", "# time, u, y\n" + written("{t}, {u}, {y}"), 1, 20, kUnwritten,
     "The headings were read from the comment in line 1."},
    {"commented_headings_over_blanks", "# logged by me\n# time, y, u\n" + written("{t} {y} {u}")},
    {"matlab_comment", "% t y u\n" + written("{t} {y} {u}")},
    {"on_and_off", "time,heater,temp\n" + written("{t},{on},{y}"), 1, 0, kUnwritten,
     "u is two levels: \"OFF\" is 0 and \"ON\" is 1."},
    {"state_of_the_heater", "time;heater state;temp\n" + written("{t};{on};{y}"), 1, 0},
    {"unnamed_switch", "time,K1,temp\n" + written("{t},{on},{y}"), 1, 0, kUnwritten,
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
    {"serial_plotter", written("T:{y},PWM:{u}"), 1, 20, kUnwritten, nullptr, seconds(1)},
    {"serial_plotter_of_a_controller", written("Setpoint:40,Input:{y},Output:{u}"), 1, 20, 40,
     "in the controller's words, because the file has a set point", seconds(1)},
    {"octoprint", written("2026-11-21 {clock},123 - Recv: ok T:{y} /200.0 B:60.1 /60.0 T0:{y} /200.0 @:{u} B@:30"), 1,
     20, 200},
    {"marlin", written(" T:{y} /200.0 B:60 /60 @:{u} B@:30"), 1, 20, 200, nullptr, seconds(1)},
    {"json_lines", written(R"({"t": {t}, "u": {u}, "y": {y}})")},
    {"json_lines_with_stamps", written(R"({"ts": "2026-11-21T{clock}Z", "temp": {y}, "heater": "{on}"})"), 1, 0},
    {"python_dictionaries", written("{'time': {t}, 'temp': {y}, 'pwm': {u}}")},
    {"measured_speed", "time,speed,measured_speed,pwm\n" + written("{t},40,{y},{u}")},
    {"measured_speed_beside_its_moving_command", "time,speed,measured_speed,pwm\n" + written("{t},{e},{y},{u}"), 1, 20,
     kUnwritten,
     "Column \"measured_speed\" is read as y, the measurement, as the measured one; it may also be \"speed\""},
    {"actual_speed", "t(s),Speed,Actual Speed,Output\n" + written("{t},40,{y},{u}")},
    {"target_and_measured", "time_ms,target_rpm,measured_rpm,pwm\n" + written("{ms},40,{y},{u}"), 1, 20, 40},
    {"two_data_sets",
     "\"uEst\",\"uVal\",\"yEst\",\"yVal\",\"Ts\",\n" +
         [] {
             std::string text = written("{u},1,{y},2,,");
             return text.replace(text.find(",,"), 2, ",1,");
         }(),
     1, 20, kUnwritten, "The file holds a second pair, \"uVal\" and \"yVal\"; choose its columns to use that one."},
    {"spacing_in_every_row", "dt,u,y\n" + written("1,{u},{y}"), 1, 20, kUnwritten,
     "Column \"dt\" gives the sample time: a row every 1 s."},
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
    {"r_table", "\"t\" \"u\" \"y\"\n" + written("\"{row}\" {t} {u} {y}"), 1, 20, kUnwritten, "contains row numbers"},
    {"terms_of_the_controller", "t,r,y,e,P,I,D,u\n" + written("{t},40,{y},{e},1,2,3,{u}"), 1, 20, 40,
     "The controller's own terms are in the file, \"e\", \"P\", \"I\" and \"D\"; they are skipped."},
    {"a_command_that_is_u", "time,cmd,rpm\n" + written("{t},{u},{y}"), 1, 20, kUnwritten, "no other column is"},
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

// Damaged logs: the result is always sentences or finite numbers. Seeded.
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
