// Feedback that is found by the controller's law over all rows, and records without feedback.
#include "engine/identification/closed_loop/recognised_law.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/closed_loop/loop_record.h"
#include "engine/identification/identify.h"
#include "engine/number_text.h"
#include "tests/engine/identification/simulated_record.h"
#include "tests/records/closed_loop_records.h"

namespace tunewright {
namespace {

using ::testing::HasSubstr;
using testing::open_loop_test;

/// A PI controller that compensates a load from before the record, smooth and short: neither u nor y has fast changes.
Record smooth_loop(double noise) {
    Record out;
    testing::Dice dice(5);
    testing::PlantRun run({1.2, 25, 4, 2, false}, 0.1);
    double y = 0, integral = 0;
    for (int i = 0; i < 140; ++i) {
        const double seen = std::round(100 * (115 + y + noise * dice.normal())) / 100;
        integral += 0.3 * (133 - seen);
        const double u = 2 * (133 - seen) + integral + 10;
        if (i >= 60) {
            out.t.push_back(i - 60);
            out.u.push_back(std::round(10 * u) / 10);
            out.y.push_back(seen);
            out.r.push_back(133);
        }
        for (int k = 0; k < 10; ++k) y = run.advance(u - (i > 55 ? 25 : 0) - 40 * std::exp(-0.05 * std::abs(i - 70)));
    }
    return out;
}

double span(const std::vector<double>& values) {
    return *std::ranges::max_element(values) - *std::ranges::min_element(values);
}

TEST(RecognisedLaw, ASmoothLoopAtAConstantSetPointIsRefused) {
    for (const double noise : {0.0, 0.01}) {
        Record record = smooth_loop(noise);
        for (const bool with_r : {true, false}) {
            if (!with_r) record.r.clear();
            const auto model = identify(record, {}, {});
            ASSERT_FALSE(model) << "K is answered: " << model->choice_reason;
            EXPECT_EQ(model.error().kind, ErrorKind::not_identifiable);
            EXPECT_THAT(model.error().message, HasSubstr("closed loop"));
            EXPECT_THAT(model.error().message,
                        HasSubstr("up to " + text(span(record.y), 2) + " (the range of y in this record)"));
        }
    }
}

TEST(RecognisedLaw, FindsGainAndIntegralOfAPiController) {
    const Record record = smooth_loop(0.0);
    const auto clean = clean_record(record);
    ASSERT_TRUE(clean);
    const auto law = recognised_law(*clean, input_at_samples(*clean), {});
    ASSERT_TRUE(law);
    const RecordScale& s = clean->scale;
    EXPECT_NEAR(law->gain * s.u_scale / s.y_scale, -2, 0.05);
    EXPECT_NEAR(law->integral * s.u_scale / s.y_scale / s.t_scale, 0.3, 0.01);
}

TEST(RecognisedLaw, LeavesRowsInManualOut) {
    Record record = smooth_loop(0.0);
    std::vector<double> automatic(record.t.size(), 1.0);
    for (std::size_t i = 30; i < 38; ++i) {
        record.u[i] += 0.3 * span(record.u) * std::sin(0.8 * static_cast<double>(i));
        automatic[i] = 0;
    }
    const auto clean = clean_record(record);
    ASSERT_TRUE(clean);
    const std::vector<double> u = input_at_samples(*clean);
    EXPECT_FALSE(recognised_law(*clean, u, {}));
    const auto law = recognised_law(*clean, u, {}, automatic);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->gain * clean->scale.u_scale / clean->scale.y_scale, -2, 0.05);
}

TEST(RecognisedLaw, OpenLoopTestsKeepToNone) {
    constexpr unsigned kTests = 600;
    constexpr int kAllowed = 3;  // 0.5 %
    int found = 0;
    std::string which;
    for (unsigned seed = 3001; seed < 3001 + kTests; ++seed) {
        const testing::SimulatedTest test = open_loop_test(seed);
        const auto clean = clean_record(test.record);
        if (!clean) continue;
        const auto loop = find_loop(*clean, test.record);
        if (!loop || !*loop) continue;
        ++found;
        which += test.what + "\n";
    }
    EXPECT_LE(found, kAllowed) << which;
}

/// u moved by hand through a lag, as a soft start, and along an S: smooth, but not a controller's response to y.
TEST(RecognisedLaw, SoftStartsByHandAreNoLoop) {
    int tests = 0;
    for (unsigned seed = 1; seed <= 24; ++seed) {
        testing::Dice dice(seed);
        const double tau = std::exp(dice.between(std::log(10), std::log(80)));
        const testing::LoopPlant plant{dice.between(0.5, 3), dice.between(3, 30), 0, dice.between(1, 6), false};
        const double noise = seed % 3 == 0 ? 0.05 : 0.01;
        testing::PlantRun run(plant, 0.1);
        Record record;
        double y = 0;
        for (int i = 0; i < 300; ++i) {
            const double since = std::max(0, i - 20), s = std::min(1.0, since / (2 * tau));
            const double u = 5 * (seed % 2 == 0 ? -std::expm1(-since / tau) : s * s * (3 - 2 * s));
            record.t.push_back(i);
            record.u.push_back(std::round(1000 * u) / 1000);
            record.y.push_back(20 + y + noise * dice.normal());
            for (int k = 0; k < 10; ++k) y = run.advance(record.u.back());
        }
        const auto model = identify(record, {}, {});
        ASSERT_TRUE(model) << "seed " << seed << ": " << model.error().message;
        EXPECT_FALSE(model->data_quality.closed_loop)
            << "seed " << seed << ", tau " << tau << ": " << model->data_quality.closed_loop->evidence;
        ++tests;
    }
    EXPECT_EQ(tests, 24);
}

/// Column r is the command sent to the actuator: u itself, u one row earlier, or an affine function of u.
TEST(RecognisedLaw, AColumnRThatIsUIsNoSetPoint) {
    for (const auto& [slope, offset, early] : {std::tuple{1.0, 0.0, 0}, {1.0, 0.0, 1}, {0.1, 5.0, 0}}) {
        Record record = testing::simulate(testing::even_times(160, 1), 0, 0, {{10, 3}, {60, 1}, {110, 2}},
                                          testing::first_order(0.9, 5, 0));
        testing::add_noise(record, 0.002, 3);
        for (std::size_t i = 0; i < record.u.size(); ++i)
            record.r.push_back(slope * record.u[std::min(i + early, record.u.size() - 1)] + offset);
        const auto model = identify(record, {}, {});
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_FALSE(model->data_quality.closed_loop);
        EXPECT_THAT(model->data_quality.notes, ::testing::Contains(HasSubstr("Column r is u itself")));
        const auto* plant = std::get_if<Fopdt>(&model->plant);
        ASSERT_NE(plant, nullptr);
        EXPECT_NEAR(plant->K, 0.9, 0.01);
    }
}

}  // namespace
}  // namespace tunewright
