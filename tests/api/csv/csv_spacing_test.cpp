// Files without times: statements of their sample time, and texts that are not one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

#include "api/csv/csv_record.h"

namespace tunewright::api {
namespace {

struct SpacingCase {
    const char* above;  ///< text above the data
    double rows_apart;  ///< s; 0: no known spacing
    bool unit_known = true;
    const char* headings = "u,y";
    const char* row = "1,20.5";
};

void PrintTo(const SpacingCase& it, std::ostream* out) { *out << it.above << " | " << it.headings << " | " << it.row; }

std::string file_of(const SpacingCase& it) {
    std::string text = std::string(it.above) + (*it.above ? "\n" : "") + it.headings + "\n";
    for (int k = 0; k < 20; ++k) text += std::string(it.row) + "\n";
    return text;
}

class FileSpacings : public testing::TestWithParam<SpacingCase> {};

TEST_P(FileSpacings, AreReadWithTheirUnitOrNotAtAll) {
    const SpacingCase& it = GetParam();
    CsvOptions options;
    options.columns.u = 1;
    options.columns.y = 2;
    const auto read = read_csv_record(file_of(it), options);
    if (it.rows_apart == 0) {
        const auto* faults = std::get_if<std::vector<CsvFault>>(&read);
        ASSERT_NE(faults, nullptr);
        EXPECT_EQ(faults->front().where, "columns/t");
        EXPECT_THAT(faults->front().message, testing::HasSubstr("enter the sampling time"));
        return;
    }
    const auto* record = std::get_if<CsvRecord>(&read);
    ASSERT_NE(record, nullptr) << std::get<std::vector<CsvFault>>(read).front().message;
    EXPECT_NEAR(record->t[1] - record->t[0], it.rows_apart, 1e-12 * it.rows_apart);
    EXPECT_EQ(record->time_unit_known, it.unit_known);
}

INSTANTIATE_TEST_SUITE_P(
    AboveTheData, FileSpacings,
    testing::Values(SpacingCase{"# Ts = 5 s", 5}, SpacingCase{"# Ts = 5", 5, false}, SpacingCase{"% Ts: 100 ms", 0.1},
                    SpacingCase{"# fs = 100 Hz", 0.01}, SpacingCase{"# fs = 100", 0.01, false},
                    SpacingCase{"# fs = 0.2 kHz", 0.005}, SpacingCase{"# Sample rate: 100 mHz", 10},
                    SpacingCase{"# Sampling rate: 5 s", 5}, SpacingCase{"# Sampling rate: 2 min", 120},
                    SpacingCase{"# Ts = 2 Hz", 0.5}, SpacingCase{"# sample rate: 6 per minute", 10},
                    SpacingCase{"# sample rate: 6/min", 10}, SpacingCase{"# sample rate: 6 samples per minute", 10},
                    SpacingCase{"# sample rate: 4 samples/s", 0.25}, SpacingCase{"# fs [1/min] = 6", 10},
                    SpacingCase{"# Ts [min] = 2", 120}, SpacingCase{"Sample Period:,5 Min", 300},
                    SpacingCase{"Sample Period:,5 Min,,", 300}, SpacingCase{"Sample Period:,5,Min,,", 300},
                    SpacingCase{"\"Sample Period:\",\"5 Sec\"", 5}, SpacingCase{"Sample Period:,5,,", 5, false}));

INSTANTIATE_TEST_SUITE_P(WithDecimalCommas, FileSpacings,
                         testing::Values(SpacingCase{"# Ts = 1,5 s", 1.5, true, "u;y", "1;20,5"},
                                         SpacingCase{"# Ts = 0,25", 0.25, false, "u;y", "1;20,5"},
                                         SpacingCase{"# Ts = 1,5 s", 1.5, true, "u;y", "1;20"},
                                         SpacingCase{"Sample Period:;1,5 Min;", 90, true, "u;y", "1;20,5"}));

INSTANTIATE_TEST_SUITE_P(WithAWordThatIsNoUnit, FileSpacings,
                         testing::Values(SpacingCase{"# Ts = 5 ticks", 0}, SpacingCase{"# Ts = 5 (see manual)", 0},
                                         SpacingCase{"# fs = 100 counts", 0}, SpacingCase{"# Ts = 1,5 s", 0},
                                         SpacingCase{"# Ts = 0 s", 0}, SpacingCase{"# fs = 6 per batch", 0},
                                         SpacingCase{"# sample rate: 4 cats/s", 0}));

INSTANTIATE_TEST_SUITE_P(InAColumn, FileSpacings,
                         testing::Values(SpacingCase{"", 5, true, "u,y,sample rate [s]", "1,20.5,5"},
                                         SpacingCase{"", 0.25, true, "u,y,sample rate [Hz]", "1,20.5,4"},
                                         SpacingCase{"", 10, true, "u,y,fs [per minute]", "1,20.5,6"},
                                         SpacingCase{"", 120, true, "u,y,Ts [min]", "1,20.5,2"},
                                         SpacingCase{"", 2, false, "u,y,dt", "1,20.5,2"},
                                         SpacingCase{"", 0.1, true, "u,y,dt", "1,20.5,100 ms"},
                                         SpacingCase{"", 0, true, "u,y,Ts [ticks]", "1,20.5,2"}));

TEST(FileSpacing, WithoutAUnitIsInTheOneThatIsGivenForTheFile) {
    CsvOptions options;
    options.file_time_unit = "min";
    const auto read = read_csv_record("# Ts = 5\nu,y\n1,20\n2,21\n2,22\n", options);
    EXPECT_EQ(std::get<CsvRecord>(read).t[1], 300);
    EXPECT_TRUE(std::get<CsvRecord>(read).time_unit_known);
}

}  // namespace
}  // namespace tunewright::api
