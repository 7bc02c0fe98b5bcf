// Kuhn's T-sum rule: the published factors with an independently computed T_sum, and the refusals.
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::expect_settings;
using test::Given;
using test::tuned;
using test::warns;
using test::word;
using testing::HasSubstr;

// The area between the step response and its end value over K is -P'(0)/P(0): here by a central difference.
double area_over_gain(const Plant& plant) {
    const LinearPlant linear = *LinearPlant::make(plant);
    constexpr double h = 1e-4;
    return -std::log(linear.at(h).real() / linear.at(-h).real()) / (2 * h);
}

const TransferFunction kThreeLags{.num = {2}, .den = {6, 11, 6, 1}, .L = 0.5};
const TransferFunction kLead{.num = {3, 3}, .den = {20, 9, 1}, .L = 1};
const OscillatorySopdt kDamped{.K = -1.5, .T = 2, .zeta = 0.8, .L = 1};

TEST(TSum, TakesThePublishedSharesOfTheSumOfAllTimes) {
    EXPECT_NEAR(area_over_gain(kThreeLags), 6.5, 1e-5);
    EXPECT_NEAR(area_over_gain(kLead), 9 - 1 + 1, 1e-5);
    const std::pair<Plant, double> plants[] = {{kThreeLags, 2}, {kLead, 3}, {kDamped, -1.5}};
    for (const auto& [plant, K] : plants) {
        const double T = area_over_gain(plant);
        expect_settings(tuned("t_sum", plant, test::kP), 1 / K, INFINITY, 0, 1e-6);
        expect_settings(tuned("t_sum", plant, test::kPI), 0.5 / K, 0.5 * T, 0, 1e-6);
        expect_settings(tuned("t_sum", plant), 1 / K, 0.66 * T, 0.167 * T, 1e-6);
        const Given fast{word("speed", "fast")}, fast_PI{word("speed", "fast"), word("controller", "PI")};
        expect_settings(tuned("t_sum", plant, fast_PI), 1 / K, 0.7 * T, 0, 1e-6);
        expect_settings(tuned("t_sum", plant, fast), 2 / K, 0.8 * T, 0.194 * T, 1e-6);
    }
}

TEST(TSum, RefusesWhatHasNoSumAndWarnsOfFastSettingsWithDeadTime) {
    const Given fast{word("speed", "fast")}, fast_P{word("speed", "fast"), word("controller", "P")};
    EXPECT_EQ(tuned("t_sum", Ipdt{.K = 1, .L = 1}).error().where, "plant");
    EXPECT_EQ(tuned("t_sum", Fopdt{.K = 1, .T = -5, .L = 1}).error().where, "plant");
    EXPECT_EQ(tuned("t_sum", Fopdt{.K = 1, .T = 5, .L = 1}, fast_P).error().where, "speed");
    const TransferFunction leads{.num = {9, 1}, .den = {2, 3, 1}, .L = 0};
    EXPECT_THAT(tuned("t_sum", leads).error().message, HasSubstr("is -6"));
    EXPECT_TRUE(warns(*tuned("t_sum", Fopdt{.K = 1, .T = 1, .L = 2}, fast), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("t_sum", Fopdt{.K = 1, .T = 1, .L = 2}), "outside-validity"));
    EXPECT_FALSE(warns(*tuned("t_sum", Fopdt{.K = 1, .T = 4, .L = 2}, fast), "outside-validity"));
}

}  // namespace
}  // namespace tunewright
