// Findings of a record before any fit, and their treatment.
#include "engine/identification/record/data_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/identification/record/false_readings.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Record good_step() {
    Record record = simulate(even_times(400, 0.5), 40, 20, {{20, 45}}, first_order(0.8, 15, 2));
    add_noise(record, 0.01, 3);
    return record;
}

CleanRecord cleaned(const Record& record) {
    const auto clean = clean_record(record);
    EXPECT_TRUE(clean) << (clean ? "" : clean.error().message);
    return clean ? *clean : CleanRecord{};
}

RecordRows rows_of(const Record& record) {
    Cleaning cleaning;
    return collect_rows(record, cleaning);
}

std::vector<std::string> codes(const Record& record) {
    const CleanRecord clean = cleaned(record);
    std::vector<std::string> out;
    for (const Warning& warning : record_warnings(clean, describe_record(clean))) out.push_back(warning.code);
    return out;
}

TEST(DataQuality, AGoodRecordHasNothingToWarnOf) {
    const DataQuality quality = describe_record(cleaned(good_step()));
    EXPECT_TRUE(codes(good_step()).empty());
    EXPECT_EQ(quality.kind, RecordKind::step);
    EXPECT_EQ(quality.u0, 40);
    EXPECT_NEAR(quality.y0, 20, 0.01);
    ASSERT_TRUE(quality.pretest);
    EXPECT_EQ(quality.pretest->samples, 40);
    EXPECT_TRUE(quality.pretest->at_rest);
    EXPECT_FALSE(quality.gaps || quality.missing || quality.outliers);
    EXPECT_TRUE(quality.saturation.empty());
}

TEST(DataQuality, DriftBeforeTheStepIsMeasured) {
    Record record = good_step();
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += 0.02 * record.t[i];
    const DataQuality quality = describe_record(cleaned(record));
    ASSERT_TRUE(quality.pretest);
    EXPECT_FALSE(quality.pretest->at_rest);
    EXPECT_NEAR(quality.pretest->drift, 0.02, 0.002);
}

TEST(DataQuality, HolesAreCountedAndTheirLengthIsMeasured) {
    Record record = good_step();
    for (int i = 100; i < 120; ++i) record.y[static_cast<std::size_t>(i)] = kNone;
    record.y[300] = kNone;
    const DataQuality quality = describe_record(cleaned(record));
    ASSERT_TRUE(quality.missing);
    EXPECT_EQ(quality.missing->count, 21);
    EXPECT_DOUBLE_EQ(quality.missing->longest, 10.5);
    EXPECT_DOUBLE_EQ(quality.missing->at, 49.5);
    EXPECT_THAT(codes(record), Contains("missing-samples"));
}

TEST(DataQuality, AMissingInputIsHeldAndItsRowKept) {
    Record record = good_step();
    record.u[90] = kNone;
    const CleanRecord clean = cleaned(record);
    EXPECT_EQ(clean.samples(), 400);
    EXPECT_EQ(clean.changes(), 1);
    EXPECT_EQ(clean.cleaning.missing_u, 1);
}

TEST(DataQuality, SpikesAreNamedByTheFilesOwnLines) {
    Record record = good_step();
    record.y[120] += 30;
    record.y[250] = -40;
    record.y[251] = -41;
    for (int i = 0; i < 400; ++i) record.line.push_back(i + 5);
    const DataQuality quality = describe_record(cleaned(record));
    ASSERT_TRUE(quality.outliers);
    EXPECT_THAT(quality.outliers->rows, ElementsAre(125, 255, 256));
    EXPECT_THAT(quality.notes, Contains(HasSubstr("removed (line 125, 255, 256)")));
}

TEST(DataQuality, ACoarseClockIsSpread) {
    Record record = good_step();
    for (double& t : record.t) t = std::floor(t / 2) * 2;
    const CleanRecord clean = cleaned(record);
    EXPECT_TRUE(clean.cleaning.spread);
    EXPECT_NEAR(describe_record(clean).sample_time, 0.5, 1e-9);
}

TEST(DataQuality, AFlatTopIsSaturationAndASettledResponseIsNone) {
    Record record = simulate(even_times(400, 0.5), 40, 20, {{20, 45}}, first_order(0.8, 15, 2));
    EXPECT_TRUE(codes(record).empty());
    for (double& y : record.y) y = std::round(y * 20) / 20;
    EXPECT_TRUE(describe_record(cleaned(record)).saturation.empty());
    for (double& y : record.y) y = std::min(y, 22.5);
    const DataQuality quality = describe_record(cleaned(record));
    ASSERT_EQ(quality.saturation.size(), 1u);
    EXPECT_DOUBLE_EQ(quality.saturation[0].level, 22.5);
    EXPECT_THAT(codes(record), Contains("saturated-output"));
}

TEST(DataQuality, AFastProcessIsNoSaturation) {
    EXPECT_TRUE(describe_record(cleaned(simulate(even_times(400, 0.5), 0, 0, {{20, 1}}, first_order(2, 0.05, 0))))
                    .saturation.empty());
}

TEST(FalseReadings, ResponsesHaveNone) {
    for (const auto& response : {first_order(2, 0.3, 1), first_order(2, 20, 1), oscillation(1, 1.5, 0.1, 0)}) {
        const Record record = simulate(even_times(300, 0.5), 0, 0, {{20, 1}, {60, -1}, {100, 0}}, response);
        EXPECT_TRUE(false_readings(rows_of(record)).empty());
    }
}

/// y with `value` in the rows [from, to).
Record with_run(double value, std::size_t from, std::size_t to) {
    Record record = good_step();
    std::fill(record.y.begin() + static_cast<std::ptrdiff_t>(from), record.y.begin() + static_cast<std::ptrdiff_t>(to),
              value);
    return record;
}

TEST(FalseReadings, WhatSensorsReportInAFaultIsFoundOnceAndInRuns) {
    for (const double value : {85.0, -127.0, 850.0, 1820.0, 0.0, 4095.0, 32767.0}) {
        for (const std::size_t length : {1, 2, 7, 20})
            EXPECT_EQ(false_readings(rows_of(with_run(value, 150, 150 + length))).size(), length) << value;
    }
    EXPECT_EQ(false_readings(rows_of(with_run(-127, 390, 400))).size(), 10u);
}

/// Runs are judged one by one, compared with the readings that do not jump: their order does not matter.
TEST(FalseReadings, DoNotDependOnTheOrderOfTheFaults) {
    std::vector<double> levels = {26, 27, 29, 40};  // y is 20 to 24: the first two are within one such range of it
    std::vector<std::size_t> faults_by_order;
    do {
        Record record = good_step();
        for (std::size_t k = 0; k < levels.size(); ++k)
            std::fill_n(record.y.begin() + static_cast<std::ptrdiff_t>(150 + 40 * k), 4, levels[k]);
        faults_by_order.push_back(false_readings(rows_of(record)).size());
    } while (std::ranges::next_permutation(levels).found);
    EXPECT_THAT(faults_by_order, ::testing::Each(8));
}

/// Jumps that are not faults do not count towards the quarter of the rows that faults may take.
TEST(FalseReadings, JumpsThatAreNoneDoNotHideTheFaults) {
    Record record = good_step();
    const double raised = record.y[200] + 2;
    for (std::ptrdiff_t i = 200; i + 12 < 400; i += 12) std::fill_n(record.y.begin() + i, 10, raised);
    std::fill_n(record.y.begin() + 120, 4, 40.0);
    const auto found = false_readings(rows_of(record));
    for (std::size_t i = 120; i < 124; ++i) EXPECT_THAT(found, Contains(i));
}

TEST(FalseReadings, AProcessThatGoesToSuchAValueKeepsIt) {
    // Steps of u with which a process as fast as its rows jumps to 85 and back, and one that passes 85 slowly.
    Record fast =
        simulate(even_times(300, 0.5), 60, 60, {{20, 85}, {40, 60}, {60, 85}, {100, 60}}, first_order(1, 0.05, 0));
    for (double& y : fast.y) y = std::round(y);
    EXPECT_TRUE(false_readings(rows_of(fast)).empty());
    Record slow = simulate(even_times(400, 0.5), 40, 60, {{20, 80}}, first_order(1, 15, 2));
    for (double& y : slow.y) y = std::round(y);
    EXPECT_TRUE(false_readings(rows_of(slow)).empty());
}

TEST(FalseReadings, TheStartIsJudgedWithoutTheSpikesBehindIt) {
    for (const std::size_t first : {1, 2, 3}) {
        Record record = with_run(-127, 200, 201);
        std::fill(record.y.begin(), record.y.begin() + static_cast<std::ptrdiff_t>(first), 85.0);
        const CleanRecord clean = cleaned(record);
        EXPECT_EQ(clean.cleaning.silent, static_cast<int>(first));
        EXPECT_EQ(clean.cleaning.spikes.size(), 1u);
        EXPECT_NEAR(clean.scale.y_origin + clean.scale.y_scale * clean.y.front(), 20, 0.1);
    }
}

TEST(PlainLimits, AreNoneThatHideTheMovesOfATestOrContradictItsScale) {
    Record record =
        simulate(even_times(400, 0.5), 0, 20, {{20, 100}, {60, 40}, {100, 100}, {140, 65}}, first_order(0.8, 15, 2));
    EXPECT_TRUE(plain_limits(record).empty());
    record = simulate(even_times(400, 0.5), 0.5, 20, {{20, 3}, {100, 0.7}}, first_order(0.8, 15, 2));
    EXPECT_FALSE(plain_limits(record).empty());
    record.u_full_scale = 100;
    EXPECT_TRUE(plain_limits(record).empty());
}

TEST(FalseReadings, ANumberThatStandsForNoneIsFoundHoweverOften) {
    Record record = good_step();
    for (std::size_t i = 0; i < 100; ++i) record.y[4 * i] = -9999;
    EXPECT_EQ(false_readings(rows_of(record)).size(), 100u);
}

}  // namespace
}  // namespace tunewright
