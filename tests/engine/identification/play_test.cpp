// Records of plants behind a backlash: it is found, sized, and not taken for a load or another gain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;

constexpr double kNoise = 0.01;

/// The response to u behind a play of this width: `above` of it lies in the way of a first move upwards. By the rule of
/// a pin in a slot, which is pushed by its ends.
Record behind_play(const std::vector<double>& t, double u0, const Steps& steps, double width, double above,
                   const StepCurve& response) {
    Steps positions;
    double slot = u0;
    for (const auto& [when, u] : steps) {
        if (u > slot + above) slot = u - above;
        if (u < slot - (width - above)) slot = u + (width - above);
        positions.emplace_back(when, slot);
    }
    Record record = simulate(t, u0, 20, positions, response);
    const Record told = simulate(t, u0, 20, steps, response);
    record.u = told.u;
    return record;
}

const Steps kThereAndBack = {{10, 11}, {70, 10}};
const Steps kTwiceEachWay = {{10, 11}, {60, 12}, {110, 11}, {160, 10}};

TEST(PlayTest, TestsThatGoTwiceEachWayShowGainAndWidth) {
    for (const double width : {0.1, 0.3, 0.6}) {
        for (const double share : {0.0, 0.5, 1.0}) {
            for (unsigned seed = 1; seed <= 2; ++seed) {
                Record record =
                    behind_play(even_times(1050, 0.2), 10, kTwiceEachWay, width, share * width, first_order(2, 8, 2));
                add_noise(record, kNoise, seed);
                const IdentifiedModel model = identified(record);
                const auto plant = plant_as<Fopdt>(model);
                SCOPED_TRACE(::testing::Message() << "width " << width << ", share " << share << ", seed " << seed);
                ASSERT_TRUE(model.data_quality.backlash);
                EXPECT_NEAR(*model.data_quality.backlash, width, 0.01);
                EXPECT_NEAR(plant.K, 2, 0.02);
                EXPECT_NEAR(plant.T, 8, 0.2);
                EXPECT_NEAR(plant.L, 2, 0.1);
                EXPECT_TRUE(warns(model, "backlash"));
                EXPECT_FALSE(warns(model, "load-disturbance"));
            }
        }
    }
}

/// A test there and back does not show how much of the play its first move found in its way: K is between the gain of
/// that move and more, and its standard error says so.
TEST(PlayTest, OfATestThereAndBackTheGainIsALowerBound) {
    constexpr double kWidth = 0.4;
    int covered = 0, records = 0;
    for (int k = 0; k < 8; ++k) {
        const double ahead = kWidth * k / 10;
        Record record = behind_play(even_times(650, 0.2), 10, kThereAndBack, kWidth, ahead, first_order(2, 8, 2));
        add_noise(record, kNoise, static_cast<unsigned>(k) + 1);
        const IdentifiedModel model = identified(record);
        const auto plant = plant_as<Fopdt>(model);
        SCOPED_TRACE(::testing::Message() << "ahead " << ahead);
        ASSERT_TRUE(model.data_quality.backlash);
        EXPECT_NEAR(plant.K, 2 * (1 - ahead), 0.03);
        EXPECT_NEAR(*model.data_quality.backlash, (kWidth - ahead) / (1 - ahead), 0.02);
        EXPECT_NEAR(plant.L, 2, 0.1);
        EXPECT_GT(model.standard_errors.at("K"), 0.2 * (*model.data_quality.backlash) * plant.K);
        covered += std::abs(plant.K - 2) <= 2 * model.standard_errors.at("K") ? 1 : 0;
        ++records;
        EXPECT_FALSE(warns(model, "load-disturbance"));
    }
    EXPECT_GE(covered, records - 2);
}

TEST(PlayTest, IsFoundDownwardsAndBehindIntegrators) {
    Record down = behind_play(even_times(650, 0.2), 10, {{10, 9}, {70, 10}}, 0.3, 0.3, first_order(-1, 8, 2));
    add_noise(down, kNoise, 3);
    const IdentifiedModel falling = identified(down);
    ASSERT_TRUE(falling.data_quality.backlash);
    EXPECT_NEAR(*falling.data_quality.backlash, 0.3, 0.02);
    EXPECT_NEAR(plant_as<Fopdt>(falling).K, -1, 0.02);

    Record level =
        behind_play(even_times(800, 0.25), 10, {{10, 11}, {60, 10}, {110, 9}, {160, 10}}, 0.3, 0, ramp(0.1, 4));
    add_noise(level, kNoise, 5);
    const IdentifiedModel integrating = identified(level);
    ASSERT_TRUE(integrating.data_quality.backlash);
    EXPECT_NEAR(*integrating.data_quality.backlash, 0.3, 0.03);
    EXPECT_NEAR(plant_as<Ipdt>(integrating).K, 0.1, 0.002);
}

/// What else leaves y elsewhere: a load or a drift at any time, other lags, nothing.
TEST(PlayTest, IsNotFoundWhereThereIsNone) {
    std::mt19937 bits(7);
    const auto between = [&](double low, double high) { return low + (high - low) * (bits() / 4294967296.0); };
    int found = 0, answered = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const Steps& steps = seed % 2 == 0 ? kThereAndBack : kTwiceEachWay;
        const StepCurve response = seed % 3 == 0 ? two_lags(1.5, between(4, 8), between(1, 3), 2)
                                                 : first_order(2, between(4, 12), between(1, 4));
        const auto t = even_times(1050, 0.2);
        Record record = simulate(t, 10, 20, steps, response);
        const double load = between(-0.8, 0.8), at = between(15, 150), slope = between(-0.01, 0.01);
        for (std::size_t i = 0; i < t.size(); ++i) {
            if (seed % 5 < 3) record.y[i] += load * response(t[i] - at);
            if (seed % 5 == 3) record.y[i] += slope * t[i];
        }
        add_noise(record, kNoise, seed);
        const auto model = identify(record, {}, {});
        if (!model) continue;  // a load that no model explains
        ++answered;
        if (model->data_quality.backlash) ++found;
    }
    EXPECT_GE(answered, 25);
    EXPECT_EQ(found, 0);
}

/// Gains that differ to both sides of rest leave y where it was at each level of u, as no play does.
TEST(PlayTest, IsNotTakenForAGainThatVaries) {
    for (const double lower : {0.6, 0.8, 1.3}) {
        const Steps steps = {{10, 11}, {70, 9}, {130, 10}}, seen = {{10, 11}, {70, 10 - lower}, {130, 10}};
        Record record = simulate(even_times(950, 0.2), 10, 20, seen, first_order(2, 8, 2));
        record.u = simulate(even_times(950, 0.2), 10, 20, steps, first_order(2, 8, 2)).u;
        add_noise(record, kNoise, 4);
        const auto model = identify(record, {}, {});
        EXPECT_FALSE(model && model->data_quality.backlash) << lower;
    }
}

/// The disturbance that moves together with u explains what a play would.
TEST(PlayTest, IsNotTakenForAMeasuredDisturbance) {
    Record record = simulate(even_times(700, 0.2), 10, 20, kThereAndBack, first_order(2, 8, 2));
    const Record other = simulate(even_times(700, 0.2), 0, 0, {{70, 1}}, first_order(0.6, 8, 2));
    for (std::size_t i = 0; i < record.y.size(); ++i) record.y[i] += other.y[i];
    record.d = {{"feed", other.u}};
    add_noise(record, kNoise, 4);
    const IdentifiedModel model = identified(record);
    EXPECT_FALSE(model.data_quality.backlash);
    ASSERT_EQ(model.disturbances.size(), 1u);
    EXPECT_NEAR(plant_as<Fopdt>(model).K, 2, 0.02);
    EXPECT_LT(model.standard_errors.at("K"), 0.02);
}

/// With a drift in addition the play is not found; the load that is found instead begins with a move, and K's error
/// covers both moves' gains.
TEST(PlayTest, ALoadThatComesWithAMoveMakesTheGainUncertain) {
    for (const double drift : {0.002, -0.002}) {
        Record record = behind_play(even_times(650, 0.2), 10, kThereAndBack, 0.3, 0, first_order(2, 8, 2));
        for (std::size_t i = 0; i < record.y.size(); ++i) record.y[i] += drift * record.t[i];
        add_noise(record, kNoise, 2);
        const IdentifiedModel model = identified(record);
        EXPECT_TRUE(model.data_quality.backlash || warns(model, "load-disturbance"));
        EXPECT_LT(std::abs(plant_as<Fopdt>(model).K - 2), 2 * model.standard_errors.at("K"));
    }
    // Far from the moves it does not.
    Record record = simulate(even_times(650, 0.2), 10, 20, kThereAndBack, first_order(2, 8, 2));
    const Record load = simulate(even_times(650, 0.2), 0, 0, {{45, 0.3}}, first_order(2, 8, 0));
    for (std::size_t i = 0; i < record.y.size(); ++i) record.y[i] += load.y[i];
    add_noise(record, kNoise, 2);
    const IdentifiedModel model = identified(record);
    EXPECT_TRUE(warns(model, "load-disturbance"));
    EXPECT_NEAR(plant_as<Fopdt>(model).K, 2, 0.02);
    EXPECT_LT(model.standard_errors.at("K"), 0.02);
}

}  // namespace
}  // namespace tunewright
