// Records that are affected by more than the plant: a controller, a logger, a valve at its end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/identification/record/record_kind.h"
#include "engine/request/tune.h"
#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"
#include "tests/records/closed_loop_records.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::Contains;
using ::testing::HasSubstr;

/// Gain 2, five lags of 10, simulated in steps of 0.1 of a row.
class FiveLags {
public:
    double advance(double u) {
        for (int k = 0; k < 10; ++k) {
            double in = 2 * u;
            for (double& x : x_) x += 0.01 * (in - x), in = x;
        }
        return x_[4];
    }

private:
    double x_[5] = {};
};

double rounded(double value, double step) { return step > 0 ? step * std::round(value / step) : value; }

/// u = Kp (r - y) + I around (40, 60) on that plant; rows every second.
struct Loop {
    double Kp = 0.15, Ti = 30, noise = 0.05, step = 0, load = 0, grid = 0;
    int rows = 700, moved_at = 60, manual_until = 0;

    Record record(bool with_r) const {
        Record out;
        Dice dice(3);
        FiveLags plant;
        double y = 0, integral = 0, u = 0;
        for (int i = 0; i < rows; ++i) {
            const double r = i >= moved_at ? step : 0, seen = y + noise * dice.normal();
            integral += Ti > 0 ? Kp / Ti * (r - seen) : 0;
            u = Kp * (r - seen) + integral;
            if (i < manual_until) u = i < moved_at ? 0 : 5, integral = u + Kp * seen;
            out.t.push_back(i);
            out.u.push_back(40 + rounded(u, grid));
            out.y.push_back(60 + rounded(seen, grid));
            if (with_r) out.r.push_back(60 + r);
            const double at = static_cast<double>(i) / 170;
            y = plant.advance(u + load * std::sin(3 * std::floor(at)));
        }
        return out;
    }
};

double static_gain(const IdentifiedModel& model) {
    return std::visit(
        [](const auto& plant) {
            if constexpr (requires { plant.num; })
                return plant.num.back();
            else if constexpr (requires { plant.K; })
                return static_cast<double>(plant.K);
            else
                return std::nan("");
        },
        model.plant);
}

TEST(DoubtfulRecords, ALoopRestsBeforeItsSetPointMovesWhateverItsNoiseDoesToU) {
    const IdentifiedModel model = identified(Loop{.step = 10}.record(true));
    EXPECT_NEAR(static_gain(model), 2, 0.1);
    EXPECT_NEAR(model.data_quality.u0, 40, 0.05);
    EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("the loop is at rest: u0 = 40")));
}

TEST(DoubtfulRecords, NoModelHasTheSignThatItsControllerWouldHaveDrivenAway) {
    for (const double u0 : {38.0, 44.85, 52.0}) {
        Record record = Loop{.step = 10}.record(true);
        record.u0 = u0;
        const auto model = identify(record, {}, {});
        EXPECT_TRUE(!model || static_gain(*model) > 0) << u0;
    }
}

TEST(DoubtfulRecords, AProportionalLoopWhoseFiguresAreRoundedIsALoop) {
    const Error error = refusal(Loop{.Kp = 0.3, .Ti = 0, .load = 8, .grid = 0.1, .rows = 1200}.record(false));
    EXPECT_THAT(error.message, HasSubstr("The record is of a closed loop"));
}

TEST(DoubtfulRecords, TheRowsInManualAreUsedWhereTheRestIsALoop) {
    const Record record = Loop{.rows = 760, .manual_until = 600}.record(false);
    const IdentifiedModel model = identified(record);
    EXPECT_NEAR(static_gain(model), 2, 0.1);
    EXPECT_FALSE(model.data_quality.closed_loop);
    EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("Only the rows from t = 0 to 599 are used")));
}

TEST(DoubtfulRecords, ASetPointThatTracksYInManualIsNone) {
    Record record = simulate(even_times(600, 1), 40, 60, {{100, 50}, {350, 40}}, first_order(2, 60, 12));
    add_noise(record, 0.1, 5);
    const std::vector<double>& y = record.y;
    std::vector<double> late = {y[0]}, round, now_and_then;
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (i > 0) late.push_back(y[i - 1]);
        round.push_back(rounded(y[i], 0.5));
        now_and_then.push_back(y[i / 5 * 5]);
    }
    for (const auto& r : {y, late, round, now_and_then}) {
        record.r = r;
        const IdentifiedModel model = identified(record, ModelChoice::fopdt);
        EXPECT_FALSE(warns(model, "closed-loop"));
        EXPECT_NEAR(plant_as<Fopdt>(model).K, 2, 0.03);
    }
}

TEST(DoubtfulRecords, AFirstRowOfBeforeTheFirstReadingIsLeftOut) {
    Record record = simulate(even_times(600, 1), 40, 60, {{100, 50}}, first_order(2, 60, 12));
    add_noise(record, 0.05, 5);
    record.u[0] = record.y[0] = 0;
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_NEAR(plant_as<Fopdt>(model).K, 2, 0.02);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, 12, 0.5);
    EXPECT_EQ(model.data_quality.steps, 1);
    EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("1 row at the start removed")));
}

TEST(DoubtfulRecords, RowsOfBeforeTheSensorIsReadAreLeftOut) {
    Record record = simulate(even_times(600, 1), 40, 25, {{100, 60}}, first_order(2, 60, 12));
    add_noise(record, 0.05, 5);
    const IdentifiedModel whole = identified(record, ModelChoice::fopdt);
    std::fill_n(record.y.begin(), 10, 0);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_NEAR(plant_as<Fopdt>(model).K, plant_as<Fopdt>(whole).K, 1e-3);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, plant_as<Fopdt>(whole).L, 0.05);
    EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("10 rows at the start removed")));
    // A plant that is a pure gain also jumps from one value to another in one row, after u.
    Record gain = simulate(even_times(100, 1), 40, 0, {{20, 60}}, first_order(2, 0.01, 3));
    add_noise(gain, 0.01, 6);
    std::fill_n(gain.y.begin(), 23, 0);
    for (const std::string& note : identified(gain, ModelChoice::fopdt).data_quality.notes)
        EXPECT_EQ(note.find("left out"), note.npos) << note;
}

TEST(DoubtfulRecords, NoLoadTakesBackAMoveOfU) {
    // The valve ends at 49: the second and third move have no effect.
    const Steps at_plant = {{100, 49}, {800, 49}, {1150, 40}};
    Record record = simulate(even_times(1500, 1), 40, 60, at_plant, first_order(2, 60, 10));
    add_noise(record, 0.1, 1);
    const Steps shown = {{100, 50}, {450, 60}, {800, 50}, {1150, 40}};
    record.u = simulate(record.t, 40, 60, shown, first_order(2, 60, 10)).u;
    const auto model = identify(record, {}, {});
    EXPECT_TRUE(!model || static_gain(*model) > 0);
}

TEST(DoubtfulRecords, FewRowsBeforeAStepAreSaidToShowNoRest) {
    Record record = simulate(even_times(300, 1), 40, 60, {{3, 50}}, first_order(2, 40, 10));
    add_noise(record, 0.05, 5);
    EXPECT_THAT(identified(record).data_quality.notes, Contains(HasSubstr("Only 3 rows before the step of u")));
    record.u0 = 40;
    EXPECT_THAT(identified(record).data_quality.notes, ::testing::Not(Contains(HasSubstr("Only 3 rows"))));
}

TEST(DoubtfulRecords, TwoStepTestsInOneFileAreNoRelay) {
    Record record = simulate(even_times(200, 1), 0, 0, {{30, 1}}, first_order(1, 15, 4));
    const Record second = simulate(even_times(100, 1), 0, 0, {{30, 1}}, first_order(1, 15, 4));
    for (std::size_t i = 0; i < second.t.size(); ++i) {
        record.t.push_back(200 + second.t[i]);
        record.u.push_back(second.u[i]);
        record.y.push_back(second.y[i]);
    }
    add_noise(record, 0.005, 3);
    const auto clean = clean_record(record);
    ASSERT_TRUE(clean);
    EXPECT_EQ(found_kind(*clean), RecordKind::several_steps);
}

TEST(DoubtfulRecords, AModelThatLeavesAPatternIsNoGoodOneToTuneOn) {
    Record record = simulate(even_times(500, 1), 40, 60, {{50, 41}}, first_order(2, 40, 10));
    for (std::size_t i = 0; i < record.t.size(); ++i)
        record.y[i] += 0.15 * std::sin(2 * std::numbers::pi * record.t[i] / 70);
    add_noise(record, 0.005, 3);
    TuningRequest request;
    request.record = record;
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    ASSERT_TRUE(result->model);
    ASSERT_GT(result->model->fit_percent, 70);
    ASSERT_LT(result->model->fit_percent, 90);
    ASSERT_TRUE(warns(*result->model, "structured-residuals"));
    const auto& found = result->controllers.front().verdict;
    EXPECT_TRUE(std::ranges::any_of(found, [](const verdict::Finding& f) { return f.code == "doubtful-model"; }));
}

}  // namespace
}  // namespace tunewright
