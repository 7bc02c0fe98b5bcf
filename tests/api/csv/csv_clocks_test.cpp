// Times in the formats of clocks and spreadsheets, and signs of typeset text.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "api/csv/csv_record.h"

namespace tunewright::api {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::Each;
using testing::HasSubstr;

constexpr int kRows = 400, kStep = 5;  // seconds

CsvRecord logged(const std::function<std::string(int)>& time) {
    std::string text = "Time,OP,PV\n";
    for (int i = 0; i < kRows; ++i) text += time(i) + fmt::format(",{},{}\n", i < 50 ? 40 : 50, 60 + 0.01 * i);
    return std::get<CsvRecord>(read_csv_record(text, {}));
}

void expect_even(const CsvRecord& record) {
    ASSERT_EQ(record.t.size(), std::size_t(kRows));
    for (int i = 0; i < kRows; ++i) ASSERT_NEAR(record.t[std::size_t(i)], kStep * i, 0.05) << i;
}

TEST(CsvClocks, SummerTimeBeginsWithoutAGap) {
    const auto wall = [](int i) {
        int seconds = 3600 + 45 * 60 + kStep * i;  // from 01:45 on
        if (seconds >= 2 * 3600) seconds += 3600;
        return fmt::format("2026-03-29 {:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
    };
    const CsvRecord record = logged(wall);
    expect_even(record);
    EXPECT_THAT(record.notes, Contains(HasSubstr("goes forward by an hour at line 182")));
}

TEST(CsvClocks, APauseOfAnHourOnAnotherDayOrInAnotherZoneIsAPause) {
    for (const std::string form :
         {"2026-03-30 {:02}:{:02}:{:02}", "2026-03-29T{:02}:{:02}:{:02}Z", "2026-06-28 {:02}:{:02}:{:02}"}) {
        const CsvRecord record = logged([&](int i) {
            int seconds = 3600 + 45 * 60 + kStep * i;
            if (seconds >= 2 * 3600) seconds += 3600;
            return fmt::format(fmt::runtime(form), seconds / 3600, seconds / 60 % 60, seconds % 60);
        });
        EXPECT_NEAR(record.t.back(), kStep * (kRows - 1) + 3600, 1e-6) << form;
    }
}

TEST(CsvClocks, MinutesAndSecondsRunOnPastTheHour) {
    const CsvRecord record = logged([](int i) {
        const int seconds = 50 * 60 + kStep * i;
        return fmt::format("{:02}:{:02}.0", seconds / 60 % 60, seconds % 60);
    });
    expect_even(record);
    EXPECT_THAT(record.notes, Contains(HasSubstr("\"50:00.0\" are read as minutes and seconds")));
}

TEST(CsvClocks, MoreThanTwentyFourOfTheFirstAreMinutes) {
    const CsvRecord record = logged([](int i) { return fmt::format("{:02}:{:02}", kStep * i / 60, kStep * i % 60); });
    expect_even(record);
    EXPECT_THAT(record.notes,
                Contains(HasSubstr("\"24:05\" is not a time of day; write 24:05:00 for hours and minutes")));
}

TEST(CsvClocks, PartsOfADayAreTold) {
    const CsvRecord record = logged([](int i) { return fmt::format("{:.8f}", 0.3 + kStep * i / 86400.0); });
    expect_even(record);
    EXPECT_THAT(record.notes, Contains(HasSubstr("Times count days, as in spreadsheets")));
}

TEST(CsvClocks, AFastRecordInSecondsStaysOne) {
    const CsvRecord from_zero = logged([](int i) { return fmt::format("{:.8f}", i * 1e-4); });
    EXPECT_NEAR(from_zero.t.back(), (kRows - 1) * 1e-4, 1e-9);
    EXPECT_THAT(from_zero.notes, Contains(HasSubstr("names no unit of time: the times are read as s, 0.0001")));
    const CsvRecord later = logged([](int i) { return fmt::format("{:.8f}", 0.3 + i / 2400.0); });
    EXPECT_NEAR(later.t.back() - later.t.front(), (kRows - 1) / 2400.0, 1e-7);
}

TEST(CsvClocks, AMinusThatIsTypesetIsAMinus) {
    const auto record =
        std::get<CsvRecord>(read_csv_record("t,u,y\n0,\xE2\x88\x92"
                                            "5.5,\xE2\x80\x93"
                                            "10\n1,\xE2\x88\x92"
                                            "4,\xE2\x88\x92"
                                            "0.25\n",
                                            {}));
    EXPECT_THAT(record.u, testing::ElementsAre(-5.5, -4));
    EXPECT_THAT(record.y, testing::ElementsAre(-10, -0.25));
}

TEST(CsvClocks, HeadingsInTwoLinesComplementEachOther) {
    std::string text = "Time,FV101,TT101\n,Steam valve,Outlet temperature\ns,%,degC\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("{},{},{}\n", kStep * i, i < 5 ? 40 : 50, 60 + 0.1 * i);
    const auto record = std::get<CsvRecord>(read_csv_record(text, {}));
    EXPECT_EQ(record.t.size(), 20U);
    EXPECT_EQ(record.u.front(), 40);
}

}  // namespace
}  // namespace tunewright::api
