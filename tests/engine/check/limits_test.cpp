// A loop whose output or measurement does not move, is at a limit, or is not recorded: what a check says of it, and
// that every figure is finite or has a reason.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/check/loop_check.h"
#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

/// A measurement that moves, and an output by row.
template <class Output>
Record record_with(const Output& u, int rows = 1000) {
    Record record;
    for (int i = 0; i < rows; ++i) {
        record.t.push_back(i);
        record.y.push_back(50 + std::sin(0.7 * i) + 0.3 * std::sin(0.13 * i));
        record.r.push_back(50);
        record.u.push_back(u(i));
    }
    return record;
}

LoopCheck answer_about(Record record, std::optional<std::array<double, 2>> u_range = {}) {
    LoopQuestion question;
    question.tag = "loop";
    question.record = std::move(record);
    question.u_range = u_range;
    auto found = check_loop(question, {});
    EXPECT_TRUE(found);
    EXPECT_TRUE(std::isfinite(found->service.saturated_low + found->service.saturated_high));
    EXPECT_TRUE(std::isfinite(found->performance.variability + found->performance.offset));
    EXPECT_TRUE(!found->performance.travel || std::isfinite(*found->performance.travel));
    EXPECT_TRUE(found->performance.travel || !found->performance.travel.why.empty());
    return *found;
}

TEST(CheckLimits, AnOutputThatRestsAtItsLimitIsSaturated) {
    const LoopCheck check = answer_about(record_with([](int) { return 100.0; }));
    EXPECT_EQ(check.cause.verdict, Verdict::saturation);
    EXPECT_DOUBLE_EQ(check.service.saturated_high, 1);
    EXPECT_EQ(answer_about(record_with([](int) { return 37.0; })).cause.verdict, Verdict::manual);
}

TEST(CheckLimits, AnOutputBeyondItsRangeIsAtTheLimit) {
    const auto u = [](int i) { return i % 10 < 3 ? 101.0 : 40.0 + i % 7; };
    EXPECT_NEAR(answer_about(record_with(u), {{0, 100}}).service.saturated_high, 0.3, 0.01);
}

TEST(CheckLimits, ASmallExcessOfPercentIsNoOtherUnit) {
    const LoopCheck check = answer_about(record_with([](int i) {
        return i == 5 ? -0.1 : i < 500 ? 100.0 : 40.0 + i * i % 7;
    }));
    EXPECT_NEAR(check.service.saturated_high, 0.5, 0.01);
    EXPECT_EQ(check.cause.verdict, Verdict::saturation);
}

TEST(CheckLimits, TheLimitsOfAnotherUnitAreUnknown) {
    const LoopCheck moving = answer_about(record_with([](int i) { return 5000.0 + 10 * (i % 7); }));
    EXPECT_EQ(moving.service.saturated_low + moving.service.saturated_high, 0);
    EXPECT_FALSE(moving.performance.travel);
    EXPECT_TRUE(moving.performance.reversals);
    const LoopCheck resting = answer_about(record_with([](int) { return 5000.0; }));
    EXPECT_EQ(resting.service.saturated_low + resting.service.saturated_high, 0);
    EXPECT_EQ(resting.cause.verdict, Verdict::manual);
}

/// A controller's own limit, below 100 %, and one in another unit: the output rests there again and again.
TEST(CheckLimits, AnOutputThatRestsAgainAndAgainIsAtALimitOfItsOwn) {
    const auto visits = [](double limit, double scale) {
        return record_with([=](int i) { return i % 250 < 100 ? limit : limit - scale * (1 + (i * i) % 7); });
    };
    for (const auto& [limit, scale] : {std::pair{80.0, 1.0}, {20.0, 0.1}}) {
        const LoopCheck check = answer_about(visits(limit, scale));
        EXPECT_NEAR(check.service.saturated_high, 0.4, 0.01) << limit;
        EXPECT_TRUE(check.cause.verdict == Verdict::saturation || check.cause.verdict == Verdict::tight);
    }
}

/// The mode says more than an output that rests.
TEST(CheckLimits, ALoopInAutomaticIsNotInManual) {
    Record record = record_with([](int i) { return i < 500 ? 80.0 : 60.0 + (i * i) % 7; });
    record.automatic.assign(record.t.size(), true);
    EXPECT_EQ(answer_about(record).cause.verdict, Verdict::saturation);
    record.automatic.assign(record.t.size(), false);
    EXPECT_EQ(answer_about(record).cause.verdict, Verdict::manual);
}

/// One long stand-still of the measurement while the output moves, also far below half of the time.
TEST(CheckLimits, AMeasurementThatFreezesForAWhileIsFrozen) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        LoopSetUp s;
        s.y_grid = 0;
        s.band = seed % 2 ? 3 : 0;
        s.jump = seed % 2 ? 2 : 0;
        Record record = simulated(s, seed);
        const std::size_t from = 900, to = from + 400 + 60 * seed;
        for (std::size_t i = from; i < to; ++i) record.y[i] = record.y[from];
        for (std::size_t i = from + 1; i < to; ++i) record.u[i] = record.u[i - 1] + 0.02 * (record.r[i] - record.y[i]);
        found += answer_about(record, {{0, 100}}).cause.verdict == Verdict::frozen ? 1 : 0;
    }
    EXPECT_GE(found, 9);
}

TEST(CheckLimits, AUnitThatIsShutDownIsNoFrozenSensor) {
    Record record = record_with([](int) { return 30.0; });
    for (double& y : record.y) y = 50;
    const LoopCheck check = answer_about(record);
    EXPECT_EQ(check.cause.verdict, Verdict::undetermined);
    EXPECT_EQ(check.cause.confidence, Confidence::open);
    EXPECT_EQ(check.action.code, ActionCode::record_again) << "a test would show nothing";
}

/// Rows without an output say nothing about whether somebody controls.
TEST(CheckLimits, AMissingOutputIsNoRestingOne) {
    LoopSetUp s;
    Record record = simulated(s, 4);
    for (std::size_t i = record.u.size() / 2; i < record.u.size(); ++i) record.u[i] = NAN;
    const LoopCheck check = answer_about(record, {{0, 100}});
    EXPECT_LT(check.service.output_still, 0.1);
    EXPECT_NE(check.cause.verdict, Verdict::manual);
}

TEST(CheckLimits, WithoutAUnitOfTimeNothingIsSaidOfAnHour) {
    LoopQuestion question;
    question.record = record_with([](int i) { return 40.0 + i % 7; });
    question.seconds = std::nullopt;
    const auto check = check_loop(question, {});
    ASSERT_TRUE(check);
    EXPECT_FALSE(check->performance.travel);
    EXPECT_FALSE(check->performance.reversals);
    EXPECT_FALSE(check->shape.dated);
}

/// Records that no diagnosis should meet: nothing crashes, and every figure is finite or has a reason.
TEST(CheckLimits, OddRecordsAreAnswered) {
    for (const double size : {1e-300, 1e300}) answer_about(record_with([size](int i) { return size * (i % 5); }));
    answer_about(record_with([](int) { return 1.0; }, 2));
    answer_about(record_with([](int) { return 1.0; }, 0));
    Record same_time = record_with([](int i) { return i % 5; });
    for (double& t : same_time.t) t = 3;
    answer_about(same_time);
    Record backwards = record_with([](int i) { return i % 5; });
    for (double& t : backwards.t) t = -t;
    answer_about(backwards);
    Record no_values = record_with([](int) { return double(NAN); });
    answer_about(no_values);
}

}  // namespace
}  // namespace tunewright::check
