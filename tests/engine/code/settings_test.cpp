#include "engine/code/settings.h"

#include <gtest/gtest.h>

#include <random>

namespace tunewright::code {
namespace {

TEST(CodeSettings, TheIdealFormGivesTheGainsToTheLastBit) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(-3, 3);
    int exact = 0;
    for (int i = 0; i < 1000; ++i) {
        const IdealPid ideal{
            .Kp = std::pow(10, size(random)), .Ti = std::pow(10, size(random)), .Td = std::pow(10, size(random))};
        const ParallelPid gains = to_parallel(ideal);
        const Settings settings = settings_of(gains);
        EXPECT_TRUE(settings.ideal);
        EXPECT_FALSE(settings.direct);
        exact += settings.Kp / settings.Ti == gains.Ki && settings.Kp * settings.Td == gains.Kd ? 1 : 0;
    }
    EXPECT_GT(exact, 990);  // the decimals of a few quotients do not give the same number back
}

TEST(CodeSettings, RoundTimesStayRound) {
    const Settings settings = settings_of(to_parallel({.Kp = 0.7, .Ti = 9.9, .Td = 1.1}));
    EXPECT_EQ(settings.Ti, 9.9);
    EXPECT_EQ(settings.Td, 1.1);
}

TEST(CodeSettings, TheActionTakesTheSign) {
    const Settings direct = settings_of({.Kp = -2, .Ki = -1, .Kd = 0});
    EXPECT_TRUE(direct.direct && direct.ideal);
    EXPECT_EQ(direct.Kp, 2);
    EXPECT_EQ(direct.Ti, 2);
    EXPECT_EQ(direct.Td, 0);
    const Settings mixed = settings_of({.Kp = 2, .Ki = -1, .Kd = 0});
    EXPECT_FALSE(mixed.ideal);
    EXPECT_EQ(mixed.Ki, -1);
    EXPECT_FALSE(settings_of({.Kp = 0, .Ki = 1}).ideal);
}

TEST(CodeSettings, TheProposedSampleTimeIsARoundOneBelowTheControllersOwnTimes) {
    const auto proposed = [](double Ti, double Td, Filter filter = {}) {
        return proposed_sample_time(to_parallel({.Kp = -3, .Ti = Ti, .Td = Td, .filter = filter})).value_or(-1);
    };
    EXPECT_EQ(proposed(9.9, 0), 0.5);
    EXPECT_EQ(proposed(10, 2), 0.2);
    EXPECT_EQ(proposed(341, 78.4, {FilterType::measurement_second_order, 7.84}), 5);
    EXPECT_EQ(proposed(341, 78.4, {FilterType::derivative, 0.199}), 0.1);
    EXPECT_EQ(proposed(1e-6, 0), 1e-7);
    const double none = std::numeric_limits<double>::infinity();
    EXPECT_EQ(proposed(none, 20), 2);
    EXPECT_EQ(proposed(none, 0), -1);
    EXPECT_FALSE(proposed_sample_time({.Kp = 0, .Ki = 1}));
}

TEST(CodeSettings, UnitsOfTimeAreSecondsByFactors) {
    EXPECT_EQ(seconds_in("s"), 1);
    EXPECT_EQ(seconds_in("ms"), 0.001);
    EXPECT_EQ(seconds_in("min"), 60);
    EXPECT_EQ(seconds_in("h"), 3600);
    EXPECT_EQ(seconds_in("d"), 86400);
    EXPECT_FALSE(seconds_in("minutes"));
    const SampledPid pid =
        in_seconds({.gains = {.Kp = 2, .Ki = 6, .Kd = 3, .filter = {FilterType::derivative, 0.5}, .setpoint_lag = 2},
                    .Ts = 0.25,
                    .computation_delay = 0.1},
                   60);
    EXPECT_EQ(pid.gains.Kp, 2);
    EXPECT_EQ(pid.gains.Ki, 0.1);
    EXPECT_EQ(pid.gains.Kd, 180);
    EXPECT_EQ(pid.gains.filter.Tf, 30);
    EXPECT_EQ(pid.gains.setpoint_lag, 120);
    EXPECT_EQ(pid.Ts, 15);
    EXPECT_EQ(pid.computation_delay, 6);
}

TEST(CodeSettings, TheTrackingTimeIsBetweenTdAndTi) {
    EXPECT_EQ(tracking_time(to_parallel({.Kp = 2, .Ti = 9, .Td = 1})), 3);
    EXPECT_EQ(tracking_time(to_parallel({.Kp = -2, .Ti = 9})), 9);
    EXPECT_FALSE(tracking_time({.Kp = 0, .Ki = 1}));
}

}  // namespace
}  // namespace tunewright::code
