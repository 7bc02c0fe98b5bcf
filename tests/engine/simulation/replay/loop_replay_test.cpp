// A replayed hour compared with loops that are written a second time, and with superposition for any model.
#include "engine/simulation/replay/loop_replay.h"

#include <gtest/gtest.h>

#include "tests/engine/simulation/replay/replay_loop.h"

namespace tunewright {
namespace {

using test::eventful_hour;
using test::law_of;
using test::own_loop;
using test::OwnPi;

LinearPlant linear(const Plant& plant) { return *LinearPlant::make(plant); }

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
    return largest;
}

const OwnPi kToday{.Kp = 0.8, .Ki = 0.02, .b = 1};
const Fopdt kPlant{.K = 2, .T = 40, .L = 12.7};
constexpr double kRound = 1e-9;  // of y and u of some 20

TEST(LoopReplay, WithTheSettingsOfTheRecordItIsTheRecordWhateverTheModel) {
    const LoopRows record = own_loop(kPlant, kToday, eventful_hour(900, 2), 35);
    for (const Plant& wrong : {Plant{Fopdt{.K = 3, .T = 30, .L = 5}}, Plant{Sopdt{.K = 1, .T1 = 70, .T2 = 9, .L = 20}},
                               Plant{Ipdt{.K = 0.03, .L = 7}}}) {
        const ReplayedRows run = replay(linear(wrong), law_of(kToday, 2), {}, record);
        EXPECT_LT(largest_difference(run.y, record.y), kRound);
        EXPECT_LT(largest_difference(run.u, record.u), kRound);
    }
}

TEST(LoopReplay, OnTheTruePlantItIsWhatOtherSettingsDoInTheSameHour) {
    const auto hour = eventful_hour(900, 2);
    const LoopRows record = own_loop(kPlant, kToday, hour, 35);
    for (const OwnPi& other : {OwnPi{.Kp = 1.3, .Ki = 0.03, .b = 1}, OwnPi{.Kp = 0.3, .Ki = 0.02, .b = 0.4},
                               OwnPi{.Kp = 1.1, .Ki = 0.025, .b = 1, .every = 3}}) {
        const LoopRows truth = own_loop(kPlant, other, hour, 35);
        const ReplayedRows run = replay(linear(kPlant), law_of(other, 2), {}, record);
        EXPECT_LT(largest_difference(run.y, truth.y), kRound);
        EXPECT_LT(largest_difference(run.u, truth.u), kRound);
        EXPECT_GT(largest_difference(record.y, truth.y), 0.3);  // the settings matter
    }
}

TEST(LoopReplay, KeepsTheLimitsOfTheActuator) {
    const auto hour = eventful_hour(900, 2);
    OwnPi other{.Kp = 1.6, .Ki = 0.03, .b = 1};
    const LoopRows record = own_loop(kPlant, kToday, hour, 35);
    const LoopRows free = own_loop(kPlant, other, hour, 35);
    other.low = 32;
    other.high = 38;
    const LoopRows truth = own_loop(kPlant, other, hour, 35);
    const ReplayedRows run =
        replay(linear(kPlant), law_of(other, 2), {.output = ActuatorLimits{other.low, other.high}}, record);
    EXPECT_LT(largest_difference(run.y, truth.y), kRound);
    EXPECT_LT(largest_difference(run.u, truth.u), kRound);
    EXPECT_GT(largest_difference(free.y, truth.y), 0.3);  // the limits matter
}

// Without an effect on y a pure integral adds Ki Ts e at every computation, y on a straight line between the rows.
TEST(LoopReplay, ComputesSeveralTimesARowWithYOnStraightLines) {
    LoopRows record{.t0 = 0, .h = 4, .u = {0, 0, 0, 0}, .y = {1, 2, 0, 4}, .r = {1, 1, 3, 3}};
    const SampledPid law{.gains = {.Kp = 0, .Ki = 0.5, .b = 1}, .Ts = 1};
    const ReplayedRows run = replay(linear(Fopdt{.K = 1e-12, .T = 1}), law, {}, record);
    // Row 1: r = 1, y = 1.25, 1.5, 1.75, 2. Row 2: r = 1, y = 1.5, 1, 0.5, then r = 3, y = 0. Row 3: y = 1, 2, 3, 4.
    const std::vector<double> expected{0, -0.5 * 2.5, -0.5 * 2.5 + 0.5 * 3, -0.5 * 2.5 + 0.5 * 3 + 0.5 * 2};
    EXPECT_LT(largest_difference(run.u, expected), 1e-9);
}

TEST(LoopReplay, EndsWhereTheLoopEscapes) {
    const LoopRows record = own_loop(kPlant, kToday, eventful_hour(900, 2), 35);
    const ReplayedRows run = replay(linear(kPlant), law_of({.Kp = 40, .Ki = 1, .b = 1}, 2), {}, record);
    EXPECT_TRUE(run.escaped);
    EXPECT_LT(run.y.size(), record.size());
    EXPECT_FALSE(replay(linear(kPlant), law_of(kToday, 2), {}, record).escaped);
}

}  // namespace
}  // namespace tunewright
