// Records of every kind, distinguished by u and by the response of y to u.
#include "engine/identification/record/record_kind.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/identification/record_files.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;

RecordKind kind_of(const Record& record) {
    const auto clean = clean_record(record);
    EXPECT_TRUE(clean) << (clean ? "" : clean.error().message);
    return clean ? found_kind(*clean) : RecordKind::automatic;
}

/// A relay with hysteresis around `threshold` on K/(T s + 1) behind a dead time, by small steps.
Record relay(double low, double high, double hysteresis, double noise, int samples, int rest = 0, unsigned seed = 1) {
    constexpr double kStep = 0.1, kTimeConstant = 10;
    constexpr int kDelay = 20;
    Record record;
    double x = 0, u = high;
    std::vector<double> sent;
    Record draws;
    draws.y.assign(static_cast<std::size_t>(samples), 0);
    add_noise(draws, noise, seed);
    for (int k = 0; k < samples; ++k) {
        const double y = x + draws.y[static_cast<std::size_t>(k)];
        if (k < rest) {
            u = 0;
        } else if (u == 0) {
            u = high;
        } else if (y > hysteresis) {
            u = low;
        } else if (y < -hysteresis) {
            u = high;
        }
        record.t.push_back(k * kStep);
        record.u.push_back(u);
        record.y.push_back(y);
        sent.push_back(u);
        const double v = k < kDelay ? 0 : sent[static_cast<std::size_t>(k - kDelay)];
        x += kStep / kTimeConstant * (v - x);
    }
    return record;
}

TEST(RecordKind, RecordedTestsAreWhatTheyWere) {
    for (const char* file : {"relay_ex1_biased_load_offset.csv", "relay_ex3_unbiased.csv",
                             "relay_integrating_unbiased.csv", "relay_unstable_unbiased.csv"}) {
        EXPECT_EQ(kind_of(read_record(file)), RecordKind::relay) << file;
    }
    for (const char* file : {"step_fopdt_clean.csv", "step_integrating_ramp.csv", "step_inverse_response.csv",
                             "step_offset_units.csv", "step_quantised.csv", "step_sopdt_noisy.csv"}) {
        EXPECT_EQ(kind_of(read_record(file)), RecordKind::step) << file;
    }
    EXPECT_EQ(kind_of(read_record("tclab-step.csv", "Time", "Q1", "T1")), RecordKind::step);
}

TEST(RecordKind, RelayWithNoiseBiasAndPreTestLevelIsFound) {
    EXPECT_EQ(kind_of(relay(-1, 1, 0.1, 0, 1000)), RecordKind::relay);
    EXPECT_EQ(kind_of(relay(-0.7, 1.3, 0.1, 0, 1000, 100)), RecordKind::relay);
    for (unsigned seed = 1; seed <= 10; ++seed)
        EXPECT_EQ(kind_of(relay(-0.7, 1.3, 0.2, 0.02, 2000, 150, seed)), RecordKind::relay) << seed;
}

TEST(RecordKind, LevelsThatAreMeasuredThemselvesMayJitter) {
    Record record = relay(-1, 1, 0.1, 0, 1000);
    std::mt19937 bits(4);
    for (double& u : record.u) u += 0.02 * (bits() / 4294967296.0 - 0.5);
    EXPECT_EQ(kind_of(record), RecordKind::relay);
    Record step = simulate(even_times(300, 1), 40, 20, {{30, 50}}, first_order(1, 30, 5));
    for (double& u : step.u) u += 0.1 * (bits() / 4294967296.0 - 0.5);
    EXPECT_EQ(kind_of(step), RecordKind::step);
}

TEST(RecordKind, MovesOfUAreToldByTheirTimesAndJitterIsNone) {
    // Times that begin elsewhere than at 0, in a unit of their own.
    Record record = simulate(even_times(300, 1), 40, 20, {{30, 50}, {200, 45}}, first_order(1, 30, 5));
    std::mt19937 bits(4);
    for (double& u : record.u) u += 0.1 * (bits() / 4294967296.0 - 0.5);
    for (double& t : record.t) t = 1000 + 60 * t;
    const auto times = move_times(*clean_record(record));
    ASSERT_EQ(times.size(), 2u);
    EXPECT_NEAR(times[0], 1000 + 60 * 30, 60);
    EXPECT_NEAR(times[1], 1000 + 60 * 200, 60);
    Steps many;
    for (int k = 1; k < 60; ++k) many.push_back({5.0 * k, k % 2 ? 1.0 : -1.0});
    const auto first = move_times(*clean_record(simulate(even_times(600, 0.5), -1, 0, many, first_order(2, 8, 2))));
    EXPECT_EQ(first.size(), 20u) << "no more are named";
    EXPECT_TRUE(std::ranges::is_sorted(first));
}

TEST(RecordKind, AStepOverThreeSamplesIsOneStep) {
    EXPECT_EQ(kind_of(simulate(even_times(300, 1), 0, 0, {{30, 0.3}, {31, 0.7}, {32, 1}}, first_order(1, 30, 5))),
              RecordKind::step);
}

TEST(RecordKind, APseudoRandomSequenceIsNoRelay) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 bits(seed);
        Steps steps;
        for (int k = 1; k < 60; ++k) steps.push_back({5.0 * k, bits() & 1 ? 1.0 : -1.0});
        const RecordKind kind = kind_of(simulate(even_times(600, 0.5), -1, 0, steps, first_order(2, 8, 2)));
        EXPECT_TRUE(kind == RecordKind::general || kind == RecordKind::several_steps) << seed;
    }
}

TEST(RecordKind, ASquareWaveThatLetsYSettleIsSeveralSteps) {
    const Steps steps = {{10, 1}, {80, 0}, {150, 1}, {220, 0}, {290, 1}, {360, 0}};
    EXPECT_EQ(kind_of(simulate(even_times(900, 0.5), 0, 20, steps, first_order(2, 8, 2))), RecordKind::several_steps);
}

TEST(RecordKind, PulsesAndStairsAreSeveralSteps) {
    const auto response = first_order(1, 10, 2);
    EXPECT_EQ(kind_of(simulate(even_times(300, 1), 0, 0, {{20, 1}, {60, 0}}, response)), RecordKind::several_steps);
    EXPECT_EQ(kind_of(simulate(even_times(300, 1), 0, 0, {{20, 1}, {90, 2}, {160, 3}}, response)),
              RecordKind::several_steps);
    EXPECT_EQ(kind_of(simulate(even_times(300, 1), 0, 0, {{20, 1}, {60, -1}, {100, 0}}, response)),
              RecordKind::several_steps);
}

TEST(RecordKind, AControllerAtWorkIsGeneral) {
    Steps steps;
    for (int k = 1; k < 200; ++k) steps.push_back({k * 1.0, std::sin(0.1 * k) + 0.3 * std::cos(0.33 * k)});
    EXPECT_EQ(kind_of(simulate(even_times(400, 0.5), 0, 0, steps, first_order(1, 10, 2))), RecordKind::general);
}

TEST(RecordKind, AStepBeforeTheFirstSampleIsAStep) {
    Record record = simulate(even_times(160, 0.5), 50, 20, {}, first_order(0.6, 15, 2));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += 10 * first_order(0.6, 15, 2)(record.t[i]);
    record.u0 = 40;
    EXPECT_EQ(kind_of(record), RecordKind::step);
}

TEST(RecordKind, SwitchesLieAtTheMovesBetweenTheLevels) {
    const auto clean = clean_record(relay(-0.7, 1.3, 0.2, 0, 1000, 100));
    ASSERT_TRUE(clean);
    const TwoLevels u = two_levels(input_levels(*clean));
    EXPECT_NEAR(u.low * clean->scale.u_scale + clean->scale.u_rest, -0.7, 1e-9);
    EXPECT_NEAR(u.high * clean->scale.u_scale + clean->scale.u_rest, 1.3, 1e-9);
    EXPECT_FALSE(u.first_is_up);
    EXPECT_EQ(static_cast<int>(u.switch_time.size()), clean->changes() - 1);
}

}  // namespace
}  // namespace tunewright
