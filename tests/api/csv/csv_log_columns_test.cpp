// The columns of a log for time, u, y and the set point: chosen, found, or refused with the cure.
#include <gmock/gmock.h>

#include "api/csv/csv_record.h"
#include "tests/api/csv/written_logs.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string faults_of(const std::string& text, const CsvOptions& options = {}) {
    const auto out = read_csv_record(text, options);
    const auto* faults = std::get_if<std::vector<CsvFault>>(&out);
    return faults ? faults->front().where + ": " + faults->front().message : "it was read";
}

TEST(Csv, HeadingsThatNothingTellsApartAreShownBesideTheValues) {
    EXPECT_THAT(
        faults_of("a,b,c,d,e\n" + written("{t},{y},{u}")),
        HasSubstr(
            "csv: Line 1 has 5 headings and the rows have 3 values, so it is not known which heading belongs to which "
            "column: headings \"a\", \"b\", \"c\", \"d\" and \"e\"; values \"0\", \"20.00\" and \"20\". Give each "
            "column one heading."));
}

TEST(Csv, AHeadingOfTimeOverNumbersThatDoNotRunMakesSurplusHeadingsOpen) {
    EXPECT_THAT(faults_of("temp,time,u,x,z\n" + written("{t},{y},{u}")),
                HasSubstr("so it is not known which heading belongs to which column"));
}

TEST(Csv, TwoClocksAreRefusedWithTheCure) {
    EXPECT_THAT(faults_of("PV Time,PV,OP Time,OP\n" + written("{clock},{y},{late},{u}")),
                HasSubstr("csv has two columns of times: \"OP\" has its own times in \"OP Time\", which differ from "
                          "those of \"PV Time\". "
                          "Export all tags at common times"));
}

TEST(Csv, SeveralHeatersThatAreDrivenAreNotGuessedAmong) {
    const std::string both =
        klipper("heater_bed: target=60 temp={y} pwm={duty} extruder: target=200 temp=199.5 pwm=0.5");
    std::string moving = both;
    moving.replace(moving.find("pwm=0.5"), 7, "pwm=0.4");
    moving.replace(moving.find("temp=199.5"), 10, "temp=199.7");
    EXPECT_THAT(faults_of(moving),
                HasSubstr("columns/u: Several columns may be u (the controller output): \"heater_bed.pwm\" and "
                          "\"extruder.pwm\". Choose one."));
    CsvOptions options;
    options.columns.y = "heater_bed.temp";
    const auto chosen = std::get<CsvRecord>(read_csv_record(moving, options));
    EXPECT_EQ(chosen.u.back(), 0.5);
    EXPECT_EQ(chosen.r.back(), 60);
    EXPECT_NEAR(chosen.y.back(), samples().back().y, 0.01);
}

TEST(Csv, LinesOfOneTagEachAreReadInEveryDialect) {
    for (const char* text :
         {"\"Time\",\"Series\",\"Value\"\n2026-11-21 14:00:00,temp,20\n2026-11-21 14:00:00,pwm,30\n",
          "entity_id,state,last_changed\nsensor.temp,20,2026-11-21T14:00:00Z\nsensor.power,30,2026-11-21T14:00:00Z\n",
          ",result,table,_time,_value,_field\n,,0,2026-11-21T14:00:00Z,20,temp\n,,1,2026-11-21T14:00:00Z,30,pwm\n"}) {
        const auto record = std::get<CsvRecord>(read_csv_record(text, {}));
        EXPECT_THAT(record.u, ElementsAre(30)) << text;
        EXPECT_THAT(record.y, ElementsAre(20)) << text;
    }
}

TEST(Csv, ALogOfSentencesIsRefusedByItsFirstLine) {
    EXPECT_THAT(
        faults_of(written("[{clock}][D][sensor:094]: 'Boiler': Sending state {y} \xC2\xB0"
                          "C with 1 decimals")),
        HasSubstr(
            "csv has neither lines of numbers in columns nor lines that each name two or more values; it begins with "
            "\"[14:05:00][D][sensor:094]"));
}

TEST(Csv, ALogWithoutTimesAsksForTheirSpacing) {
    EXPECT_THAT(faults_of(written("T:{y},PWM:{u}")),
                HasSubstr("columns/t: No time column found. Choose one or enter the sampling time."));
}

TEST(Csv, ASetPointIsNeitherUNorY) {
    for (const char* name :
         {"SP", "setpoint", "set point", "Set_Point", "target", "Sollwert", "consigne", "reference", "r", "w",
          "TIC101.SP", "targetTemp", "T_set", "temp target", "rpm_ref", "SV", "desired speed", "pv_sp"}) {
        SCOPED_TRACE(name);
        EXPECT_THAT(faults_of("time," + std::string(name) + ",temp\n" + written("{t},{u},{y}")),
                    HasSubstr("columns/u: No column is clearly u"));
        EXPECT_THAT(faults_of("time," + std::string(name) + ",valve\n" + written("{t},{y},{u}")),
                    HasSubstr("columns/y: No column is clearly y"));
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
    EXPECT_THAT(faults_of("t,u,y,SP\n0,1,2,5\n", options),
                HasSubstr("columns/r: r is \"none\", which is not a heading"));
}

TEST(Csv, InputAndOutputWithoutASetPointAreToldByWhatTheyDo) {
    EXPECT_THAT(faults_of("time,input,output\n0,1,2\n1,2,3\n2,3,3.5\n3,3.5,4\n4,5,7\n"),
                HasSubstr("\"input\" and \"output\" may be those of the plant or of the controller, and the numbers do "
                          "not show which."));
}

TEST(Csv, WordsBesideNumbersAreNoLevels) {
    EXPECT_THAT(faults_of("t,u,y\n0,50,2\n1,OFF,3\n"), HasSubstr("Line 3, column \"u\": \"OFF\" is not a number."));
    EXPECT_THAT(faults_of("t,u,y\n0,50,ON\n1,51,OFF\n"), HasSubstr("is not a number."));
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
                Contains(HasSubstr("The file names no unit of time: the times are read as s, 20 or more apart.")));
    CsvOptions given;
    given.time_unit_given = true;
    EXPECT_THAT(notes(given), IsEmpty());
}

// Serial monitors print their own clock before the program's output.
TEST(Csv, ACounterWithoutUnitIsReadByTheClockBesideIt) {
    for (const auto& [unit, in_a_second] : {std::pair{"ms", 1000}, {"s", 1}}) {
        std::string log, table = "stamp,t,pwm,temp\n";
        for (int k = 0; k < 40; ++k) {
            const std::string clock =
                "07:5" + std::to_string(8 + k / 30) + ":" + (k % 30 < 5 ? "0" : "") + std::to_string(2 * (k % 30));
            const std::string t = std::to_string(2 * k * in_a_second), pwm = k < 10 ? "76" : "128",
                              temp = "4" + std::to_string(k % 7) + ".5";
            log += clock + " -> t:" + t + " pwm:" + pwm + " temp:" + temp + "\n";
            table += clock + "," + t + "," + pwm + "," + temp + "\n";
        }
        CsvOptions by_counter;
        by_counter.columns.t = "t";
        for (const auto& read : {read_csv_record(log, {}), read_csv_record(table, by_counter)}) {
            const auto* record = std::get_if<CsvRecord>(&read);
            ASSERT_NE(record, nullptr);
            EXPECT_EQ(record->t.back() - record->t.front(), 78) << unit;
            EXPECT_TRUE(record->time_unit_known);
            EXPECT_THAT(record->notes,
                        Contains("Times count " + std::string(unit) + ", by comparison with the clock in the file."));
        }
    }
}

TEST(Csv, PlainTablesGetNoRemarks) {
    EXPECT_THAT(std::get<CsvRecord>(read_csv_record("t,u,y\n0,1,2\n1,1,3\n", {})).notes, IsEmpty());
}

}  // namespace
}  // namespace tunewright::api
