// Recorded tests in exported files.
#include <gmock/gmock.h>

#include "api/csv/csv_record.h"
#include "api/csv/time_stamp.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CsvRecord read(std::string_view text, const CsvOptions& options = {}) {
    auto out = read_csv_record(text, options);
    if (auto* faults = std::get_if<std::vector<CsvFault>>(&out)) {
        ADD_FAILURE() << faults->front().where << ": " << faults->front().message;
        return {};
    }
    return std::get<CsvRecord>(std::move(out));
}

CsvFault fault(std::string_view text, const CsvOptions& options = {}) {
    auto out = read_csv_record(text, options);
    if (auto* faults = std::get_if<std::vector<CsvFault>>(&out)) return faults->front();
    return {"none", "it was read"};
}

CsvOptions chosen_columns(ColumnChoice t, ColumnChoice u, ColumnChoice y) {
    CsvOptions options;
    options.columns = {t, u, y};
    return options;
}

TEST(Csv, PlainHeadingsNeedNoChoice) {
    const CsvRecord record = read("t,u,y\n0,1,2\n0.5,1.5,-2e-3\n");
    EXPECT_THAT(record.t, ElementsAre(0, 0.5));
    EXPECT_THAT(record.u, ElementsAre(1, 1.5));
    EXPECT_THAT(record.y, ElementsAre(2, -2e-3));
    EXPECT_EQ(record.dropped, 0);
}

TEST(Csv, TheRecordedHeaterStepIsReadAsExported) {
    const CsvRecord record = read(data_file("records/tclab-step.csv"), chosen_columns("Time", "Q1", "T1"));
    ASSERT_EQ(record.t.size(), 801u);
    EXPECT_EQ(record.t.front(), 0);
    EXPECT_EQ(record.t.back(), 799);
    EXPECT_EQ(record.u[0], 0);
    EXPECT_EQ(record.u[1], 50);
    EXPECT_EQ(record.y[0], 20.9);
    EXPECT_EQ(record.y[7], 21.22);
}

TEST(Csv, TheRecordedHeaterStepNeedsNoChoiceWithoutTheSecondSensor) {
    const CsvRecord record = read(",Unnamed: 0,Time,T1,Q1\n0,0,0.0,20.9,0\n1,1,1.0,21,50\n");
    EXPECT_THAT(record.t, ElementsAre(0, 1));
    EXPECT_THAT(record.u, ElementsAre(0, 50));
    EXPECT_THAT(record.y, ElementsAre(20.9, 21));
}

TEST(Csv, SemicolonsWithDecimalCommas) {
    const CsvRecord record = read("Zeit;Stellgröße;Istwert\n0,0;1,5;20,25\n0,1;1,5;-3\n");
    EXPECT_THAT(record.t, ElementsAre(0, 0.1));
    EXPECT_THAT(record.u, ElementsAre(1.5, 1.5));
    EXPECT_THAT(record.y, ElementsAre(20.25, -3));
}

TEST(Csv, ATitleWithCommasHidesNoOtherSeparator) {
    for (const std::string separator : {";", "\t"}) {
        const auto row = [&](const std::string& t, const std::string& u, const std::string& y) {
            return t + separator + u + separator + y + "\n";
        };
        std::string text = "Tank 5, heater, test\n" + row("t", "u", "y");
        for (int k = 0; k < 12; ++k)
            text += row(std::to_string(k), k < 5 ? "0,00" : "0,50", "20,0" + std::to_string(k % 10));
        const CsvRecord record = read(text);
        ASSERT_EQ(record.t.size(), 12U) << separator;
        EXPECT_EQ(record.u.back(), 0.5);
        EXPECT_EQ(record.y[3], 20.03);
    }
}

TEST(Csv, TabsAndWindowsLineEndsAndByteOrderMark) {
    const CsvRecord record = read("\xEF\xBB\xBFtime\top\tpv\r\n0\t1\t2\r\n1\t1\t3\r\n");
    EXPECT_THAT(record.t, ElementsAre(0, 1));
    EXPECT_THAT(record.y, ElementsAre(2, 3));
}

TEST(Csv, QuotedHeadingsMayHoldSeparatorsAndQuotes) {
    const CsvRecord record =
        read("\"t\",\"valve, \"\"A\"\"\",\"y\"\n\"0\",\"1,5\",\"2\"\n", chosen_columns("t", "valve, \"A\"", "y"));
    EXPECT_THAT(record.u, ElementsAre(1.5));
}

TEST(Csv, ALetterOfSeveralBytesIsNoSeparator) {
    const CsvRecord record = read("sep=\xC3\xBF\nt,u,y\xC3\xBC\n0,1,2\n1,1,3\n", chosen_columns("t", "u", "y\xC3\xBC"));
    EXPECT_THAT(record.y, ElementsAre(2, 3));
}

TEST(Csv, ASingleQuoteInAQuotedCellHidesNoLetter) {
    // The letter behind it has two bytes: half of it would not be valid text.
    const CsvRecord record =
        read("\"t\",\"a\"\xC3\xB9\"b\"\"\",\"y\"\n0,1,2\n1,1,3\n", chosen_columns("t", "a\"\xC3\xB9\"b\"", "y"));
    EXPECT_THAT(record.y, ElementsAre(2, 3));
}

TEST(Csv, UnitsInHeadingsDoNotHideTheName) {
    const CsvRecord record = read("Time [s],OP (%),PV / degC\n0,1,2\n");
    EXPECT_THAT(record.y, ElementsAre(2));
}

TEST(Csv, AUnitOfTimeInTheHeadingIsConvertedAndSaid) {
    CsvOptions options;
    options.time_unit = "min";
    options.time_unit_given = true;
    const CsvRecord record = read("Time (ms),u,y\n0,1,2\n30000,1,2\n", options);
    EXPECT_THAT(record.t, ElementsAre(0, 0.5));
    EXPECT_THAT(record.notes, testing::Contains(HasSubstr("from ms to min")));
}

TEST(Csv, AUnitMayBeAnyCountOfOne) {
    EXPECT_THAT(read("Time (100ms),u,y\n0,1,2\n30,1,2\n").t, ElementsAre(0, 3));
    EXPECT_THAT(read("Time [0.5 min],u,y\n0,1,2\n30,1,2\n").t, ElementsAre(0, 900));
}

TEST(Csv, ALineOfUnitsBelowTheHeadingsIsNoData) {
    const CsvRecord record = read("time,u,y\nh,%,degC\n1,0,5\n2,0,5\n");
    EXPECT_THAT(record.t, ElementsAre(3600, 7200));
}

TEST(Csv, TimeStampsBecomeTheUnitOfTime) {
    CsvOptions options;
    options.time_unit = "h";
    const CsvRecord record =
        read("Timestamp;MV;PV\n2024-02-28T23:30:00Z;1;2\n2024-02-29 01:00:00.0+00:30;1;2\n2024-03-01T00:30:00Z;1;2\n",
             options);
    ASSERT_EQ(record.t.size(), 3u);
    EXPECT_DOUBLE_EQ(record.t[0], 0);
    EXPECT_DOUBLE_EQ(record.t[1], 1);
    EXPECT_DOUBLE_EQ(record.t[2], 25);
}

TEST(Csv, AClockThatPassesMidnightGoesOn) {
    EXPECT_THAT(read("time,u,y\n23:59:59.5,0,0\n00:00:00.5,0,0\n00:00:01.5,0,0\n").t, ElementsAre(0, 1, 2));
}

TEST(Csv, TimeStampsNeedAUnitTheyCanBeConvertedTo) {
    CsvOptions options;
    options.time_unit = "shifts";
    options.time_unit_given = true;
    EXPECT_THAT(fault("time,u,y\n2024-01-01T00:00:00Z,0,0\n", options).message,
                HasSubstr("\"shifts\"; it must be a unit"));
}

TEST(Csv, LinesWithoutATimeOrAnyValueAreDroppedAndCounted) {
    const CsvRecord record = read("t,u,y\n0,1,2\n,1,2\n2,,NaN\n3\n\n# a remark\nnull,1,#N/A\n5,1,7\n");
    EXPECT_THAT(record.t, ElementsAre(0, 5));
    EXPECT_THAT(record.lines, ElementsAre(2, 9));
    EXPECT_EQ(record.dropped, 4);
}

TEST(Csv, AnEmptyCellKeepsTheOther) {
    const CsvRecord record = read("t,u,y\n0,1,2\n1,,3\n2,4,Bad\n3,4,I/O Timeout\n4,5,6\n");
    EXPECT_THAT(record.t, ElementsAre(0, 1, 2, 3, 4));
    EXPECT_TRUE(std::isnan(record.u[1]));
    EXPECT_TRUE(std::isnan(record.y[2]) && std::isnan(record.y[3]));
    EXPECT_EQ(record.u[2], 4);
    EXPECT_EQ(record.dropped, 0);
    EXPECT_THAT(record.notes, testing::Contains(HasSubstr("\"Bad\" and similar texts are read as missing values")));
}

TEST(Csv, ColumnsMayBeNumbersWhereThereAreNoHeadings) {
    CsvOptions options = chosen_columns(2, 3, 1);
    const CsvRecord record = read("7,0,1\n8,1,1\n", options);
    EXPECT_THAT(record.t, ElementsAre(0, 1));
    EXPECT_THAT(record.y, ElementsAre(7, 8));
    EXPECT_THAT(fault("7,0,1\n").message, HasSubstr("no headings"));
    options.columns.y = 4;
    EXPECT_THAT(fault("7,0,1\n", options).message, HasSubstr("the csv has columns 1 to 3"));
}

TEST(Csv, SpacingStandsInForATimeColumn) {
    CsvOptions options;
    options.dt = 0.25;
    EXPECT_THAT(read("u,y\n0,1\n1,2\n1,3\n", options).t, ElementsAre(0, 0.25, 0.5));
}

TEST(Csv, NamesAreFoundWithoutCaseButNotGuessedAmongSeveral) {
    EXPECT_THAT(read("TIME,Heater,Temp\n0,1,2\n").y, ElementsAre(2));
    const CsvFault several = fault("time,u,A,B\n0,1,2,3\n");
    EXPECT_EQ(several.where, "columns/y");
    EXPECT_THAT(several.message, HasSubstr("The headings are \"time\", \"u\", \"A\" and \"B\""));
}

TEST(Csv, FaultsNameLineColumnAndText) {
    EXPECT_THAT(fault("t,u,y\n0,1,2\n\n1,sticks,2\n").message,
                HasSubstr("Line 4, column \"u\": \"sticks\" is not a number."));
    EXPECT_THAT(fault("t,u,y\n0,1,2,5\n").message, HasSubstr("Line 2 has 4 cells and the first line 3"));
    EXPECT_THAT(fault("t,u,y\n0,1,inf\n").message, HasSubstr("\"inf\" is not a number"));
    EXPECT_THAT(fault("t,u,y\n0,1,1e999\n").message, HasSubstr("is not a number"));
    EXPECT_THAT(fault("").message, HasSubstr("csv is empty"));
    EXPECT_THAT(fault("t,u,y\n,1,1\n").message, HasSubstr("no complete sample"));
}

TEST(Csv, OneColumnCannotBeTwoThings) {
    EXPECT_THAT(fault("t,u,y\n0,1,2\n", chosen_columns("t", "u", "u")).message, HasSubstr("the same column"));
}

TEST(Csv, TooManySamplesAreRefused) {
    CsvOptions options;
    options.max_samples = 2;
    EXPECT_THAT(fault("t,u,y\n0,1,2\n1,1,2\n2,1,2\n", options).message, HasSubstr("more than 2 samples"));
}

TEST(TimeStamps, AreSecondsSinceTheEpoch) {
    EXPECT_EQ(read_time_stamp("1970-01-02T00:00:01Z")->seconds, 86401);
    EXPECT_EQ(read_time_stamp("2024-03-01T12:00:00+02:00")->seconds, 1709287200);  // date -u -d 2024-03-01T10:00:00 +%s
    EXPECT_EQ(read_time_stamp("2024/03/01 10:00")->seconds, 1709287200);
    EXPECT_DOUBLE_EQ(read_time_stamp("12:00:00,25")->seconds, 43200.25);
}

TEST(TimeStamps, OtherTextsAreNone) {
    for (const char* text : {"", "2024", "20.5", "2024-13-01", "2023-02-29", "25:00:00", "100:00", "12:60",
                             "2024-01-01T", "2024-01-01T10", "12:00:00Q", "noon"}) {
        EXPECT_FALSE(read_time_stamp(text).has_value()) << text;
    }
}

}  // namespace
}  // namespace tunewright::api
