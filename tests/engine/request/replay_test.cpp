// Which records are replayed, what an entry's replay says, and how wide its band is.
#include "engine/request/replay/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "engine/request/replay/loop_rows.h"
#include "tests/engine/simulation/replay/replay_loop.h"

namespace tunewright {
namespace {

using test::eventful_hour;
using test::own_loop;
using test::OwnPi;

const Fopdt kTrue{.K = 2, .T = 40, .L = 12};
const OwnPi kUsed{.Kp = 0.6, .Ki = 0.012, .b = 1};
constexpr double kRow = 2;

Record as_record(const LoopRows& rows) {
    Record record;
    for (std::size_t k = 0; k < rows.size(); ++k) record.t.push_back(100 + rows.h * static_cast<double>(k));
    record.u = rows.u;
    record.y = rows.y;
    record.r = rows.r;
    return record;
}

std::shared_ptr<const IdentifiedLoop> loop_of(const Record& record) {
    const CleanRecord clean = *clean_record(record);
    return std::make_shared<const IdentifiedLoop>(identified_loop(clean, set_point_of(clean, record), record));
}

/// What identification would say of it, with these relative standard errors of K, T and L.
IdentifiedModel model_without_rows(const Fopdt& plant, double error) {
    IdentifiedModel model;
    model.plant = plant;
    model.fit_percent = 95;
    model.covariance.names = {"K", "T", "L"};
    const double K = error * plant.K, T = error * plant.T, L = error * plant.L;
    model.covariance.matrix = {{K * K, 0, 0}, {0, T * T, 0}, {0, 0, L * L}};
    model.data_quality.closed_loop.emplace().used = LoopExcitation::set_point;
    model.data_quality.u0 = 35;
    return model;
}

TuningEntry entry_of(const OwnPi& pi) {
    TuningEntry entry;
    entry.evaluation.emplace();
    entry.evaluation->controller = ParallelPid{.Kp = pi.Kp, .Ki = pi.Ki, .b = pi.b};
    return entry;
}

class Replayed : public testing::Test {
protected:
    test::OwnHour hour_ = eventful_hour(1500, kRow);
    LoopRows rows_ = own_loop(kTrue, kUsed, hour_, 35);
    TuningRequest request_ = [this] {
        TuningRequest request;
        request.record = as_record(rows_);
        request.evaluate.points = 101;
        return request;
    }();

    IdentifiedModel model_of(const Fopdt& plant, double error) const {
        IdentifiedModel model = model_without_rows(plant, error);
        model.loop = loop_of(*request_.record);
        return model;
    }
    std::optional<ReplayRefusal> refused(const IdentifiedModel& model) const {
        return RecordReplayer(request_, model).record().refused;
    }
    double IAE_of(const OwnPi& pi) const {
        const LoopRows run = own_loop(kTrue, pi, hour_, 35);
        return replay_figures(run.h, run.r, run.y, run.u, 0).IAE;
    }
};

TEST_F(Replayed, TellsTheRatioOfOtherSettingsWithinItsBand) {
    const OwnPi other{.Kp = 1.1, .Ki = 0.024, .b = 1};
    const double truth = IAE_of(other) / IAE_of(kUsed);
    ASSERT_LT(truth, 0.8);
    for (const double factor : {0.95, 1.0, 1.05}) {
        const IdentifiedModel model = model_of({.K = kTrue.K * factor, .T = kTrue.T / factor, .L = kTrue.L}, 0.03);
        const RecordReplayer replayer(request_, model);
        ASSERT_FALSE(replayer.record().refused);
        const auto replay = replayer.of(entry_of(other));
        ASSERT_TRUE(replay && !replay->refused);
        EXPECT_NEAR(replay->IAE_ratio, truth, 0.15 * truth);
        EXPECT_LE(replay->IAE_ratio_low, truth);
        EXPECT_GE(replay->IAE_ratio_high, truth);
        EXPECT_EQ(replay->trace.y.size(), 101u);
        EXPECT_EQ(replayer.record().t.size(), 101u);
        EXPECT_DOUBLE_EQ(replayer.record().from, 100);
        EXPECT_NEAR(replayer.record().to, 100 + 1499 * kRow, 1e-6);
    }
}

// Up to the error that the band allows for: a continuous controller computes several times per row, that of the record
// once.
TEST_F(Replayed, OfTheSettingsOfTheRecordIsTheRecord) {
    const IdentifiedModel model = model_of({.K = 2.5, .T = 35, .L = 14}, 0.05);
    const auto replay = RecordReplayer(request_, model).of(entry_of(kUsed));
    ASSERT_TRUE(replay && !replay->refused);
    EXPECT_NEAR(replay->IAE_ratio, 1, 0.03);
    ASSERT_TRUE(replay->travel_ratio);
    EXPECT_NEAR(*replay->travel_ratio, 1, 0.05);
}

TEST_F(Replayed, AWiderRegionHasAWiderBandUntilNothingIsSaid) {
    const OwnPi other{.Kp = 1.1, .Ki = 0.024, .b = 1};
    double before = 0;
    for (const double error : {0.01, 0.02, 0.03}) {
        const auto replay = RecordReplayer(request_, model_of(kTrue, error)).of(entry_of(other));
        ASSERT_TRUE(replay && !replay->refused);
        const double width = replay->IAE_ratio_high - replay->IAE_ratio_low;
        EXPECT_GT(width, before);
        before = width;
    }
    const auto open = RecordReplayer(request_, model_of(kTrue, 0.2)).of(entry_of(other));
    ASSERT_TRUE(open && open->refused);
    EXPECT_TRUE(open->refused == ReplayRefusal::wide_band || open->refused == ReplayRefusal::unstable);
}

TEST_F(Replayed, RefusesWhatSaysNothingOfTheSettings) {
    const IdentifiedModel good = model_of(kTrue, 0.03);
    EXPECT_FALSE(refused(good));

    IdentifiedModel manual = good;
    manual.data_quality.closed_loop.reset();
    EXPECT_EQ(refused(manual), ReplayRefusal::manual);

    IdentifiedModel unexcited = good;
    unexcited.data_quality.closed_loop->used = LoopExcitation::none;
    EXPECT_EQ(refused(unexcited), ReplayRefusal::feedback);

    IdentifiedModel bad = good;
    bad.warnings.push_back({"contradictory-levels", "", WarningLevel::bad});
    EXPECT_EQ(refused(bad), ReplayRefusal::doubtful_model);
    EXPECT_FALSE(RecordReplayer(request_, bad).of(entry_of(kUsed)));

    IdentifiedModel blind = good;
    blind.covariance = {};
    EXPECT_EQ(refused(blind), ReplayRefusal::unknown_region);

    IdentifiedModel noisy = good;
    noisy.data_quality.noise_std = 50;
    EXPECT_EQ(refused(noisy), ReplayRefusal::no_error);

    request_.record->r.clear();
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::no_set_point);
    request_.record->r = request_.record->y;
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::no_set_point) << "column r follows y";
}

// Limits of u keep an unstable loop within bounds: it is the loop that decides, not how far y goes.
TEST_F(Replayed, RefusesAnUnstableLoopAlsoWithinLimitsOfU) {
    request_.evaluate.actuator = ActuatorLimits{.min = -35, .max = 65};
    for (const double factor : {1.0, 2.0}) {
        const auto replay =
            RecordReplayer(request_, model_of(kTrue, 0.03)).of(entry_of({.Kp = 3.5 * factor, .Ki = 0.2, .b = 1}));
        ASSERT_TRUE(replay);
        EXPECT_EQ(replay->refused, ReplayRefusal::unstable) << factor;
    }
}

// Before a controller was switched on the error is nobody's: with it the same settings would seem much better.
TEST_F(Replayed, RefusesARecordThatBeginsInManual) {
    constexpr std::size_t kManual = 150;
    auto hour = hour_;
    for (std::size_t k = 1; k < hour.r.size(); ++k) hour.r[k] += 5;
    LoopRows loop = own_loop(kTrue, kUsed, hour, 35);
    std::vector<double> rest;
    for (std::size_t k = 0; k < kManual; ++k) rest.push_back(20 + 0.05 * std::sin(0.17 * static_cast<double>(k)));
    loop.y.insert(loop.y.begin(), rest.begin(), rest.end());
    loop.u.insert(loop.u.begin(), kManual, loop.u.front());
    loop.r.front() = loop.r[1];
    loop.r.insert(loop.r.begin(), kManual, loop.r.front());
    request_.record = as_record(loop);
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::manual_rows);
    // The part in automatic is replayed.
    request_.record = as_record(own_loop(kTrue, kUsed, hour, 35));
    EXPECT_FALSE(refused(model_of(kTrue, 0.03)));
}

TEST_F(Replayed, RefusesARecordWithAPartInManual) {
    Record& record = *request_.record;
    for (std::size_t k = 300; k < 400; ++k) {
        record.u[k] = record.u[300];
        record.y[k] += 4;
    }
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::manual_rows);
}

// The column of the mode decides: what looks like manual may be a controller at its limit or one that rests.
TEST_F(Replayed, TakesTheLongestStretchInAutomaticByTheMode) {
    Record& record = *request_.record;
    for (std::size_t k = 300; k < 400; ++k) {
        record.u[k] = record.u[300];
        record.y[k] += 4;
    }
    record.automatic.assign(record.t.size(), true);
    EXPECT_FALSE(refused(model_of(kTrue, 0.03))) << "in automatic throughout";
    for (std::size_t k = 300; k < 400; ++k) record.automatic[k] = false;
    record.automatic[1450] = false;
    const IdentifiedModel model = model_of(kTrue, 0.03);
    const RecordReplayer replayer(request_, model);
    ASSERT_FALSE(replayer.record().refused);
    EXPECT_NEAR(replayer.record().from, 100 + 400 * kRow, 1e-6);
    EXPECT_NEAR(replayer.record().to, 100 + 1449 * kRow, 1e-6);
    double IAE = 0;
    for (std::size_t k = 400; k < 1450; ++k) IAE += kRow * std::abs(record.r[k] - record.y[k]);
    EXPECT_NEAR(replayer.record().figures.IAE, IAE, 0.02 * IAE);
    // The settings of the record are the record, from the first row in automatic on.
    const auto replay = replayer.of(entry_of(kUsed));
    ASSERT_TRUE(replay && !replay->refused);
    EXPECT_NEAR(replay->IAE_ratio, 1, 0.03);

    record.automatic.assign(record.t.size(), false);
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::manual_rows);
    for (std::size_t k = 0; k < kMinReplayRows; ++k) record.automatic[700 + k] = true;
    EXPECT_NE(refused(model_of(kTrue, 0.03)), ReplayRefusal::manual_rows);
    record.automatic[700] = false;
    EXPECT_EQ(refused(model_of(kTrue, 0.03)), ReplayRefusal::manual_rows);
}

// Of a long record the last rows are replayed at their own spacing: a wider one would be another loop.
TEST(LoopRows, OfALongRecordTheLastRowsStayAtTheirSpacing) {
    const auto hour = test::eventful_hour(30'000, kRow);
    const LoopRows rows = own_loop(kTrue, kUsed, hour, 35);
    const auto loop = rows_in_automatic(*loop_of(as_record(rows)));
    ASSERT_TRUE(loop);
    ASSERT_EQ(loop->size(), std::size_t{kMaxReplayRows});
    EXPECT_NEAR(loop->h, kRow, 1e-9);
    EXPECT_NEAR(loop->t0, 100 + 10'000 * kRow, 1e-6);
    EXPECT_NEAR(loop->y.back(), rows.y.back(), 1e-6);
    EXPECT_NEAR(loop->y.front(), rows.y[10'000], 1e-6);
}

// Between two rows of a fast plant a controller would have to act.
TEST_F(Replayed, RefusesRowsThatAreTooFarApartForThePlant) {
    EXPECT_EQ(refused(model_of({.K = 2, .T = 8, .L = 2}, 0.03)), ReplayRefusal::coarse_rows);
    EXPECT_FALSE(refused(model_of({.K = 2, .T = 20, .L = 4}, 0.03)));
}

TEST_F(Replayed, RefusesSettingsWhoseLoopIsUnstable) {
    const auto replay = RecordReplayer(request_, model_of(kTrue, 0.03)).of(entry_of({.Kp = 40, .Ki = 1, .b = 1}));
    ASSERT_TRUE(replay);
    EXPECT_EQ(replay->refused, ReplayRefusal::unstable);
}

TEST(LoopRows, PutARecordOnEvenRows) {
    Record record;
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < 40; ++k) {
        if (k == 17) continue;  // a row is missing
        record.t.push_back(10 + 0.5 * k);
        record.u.push_back(k < 20 ? 3 : 7);
        record.y.push_back(k == 25 ? none : 2 + 0.25 * k);
        record.r.push_back(k < 10 ? 4 : 6);
    }
    const auto rows = rows_in_automatic(*loop_of(record));
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 40u);
    EXPECT_NEAR(rows->h, 0.5, 1e-9);
    for (std::size_t k = 0; k < 40; ++k) {
        EXPECT_NEAR(rows->y[k], 2 + 0.25 * static_cast<double>(k), 1e-9);
        EXPECT_NEAR(rows->u[k], k < 20 ? 3 : 7, 1e-9);
        EXPECT_EQ(rows->r[k], k < 10 ? 4 : 6);
    }
}

}  // namespace
}  // namespace tunewright
