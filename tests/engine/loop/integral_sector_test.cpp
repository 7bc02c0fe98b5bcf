#include "engine/loop/integral_sector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/loop/stability.h"

namespace tunewright {
namespace {

IntegralSector judged(const Plant& plant, const IdealPid& pid) {
    const auto linear = *LinearPlant::make(plant);
    return judge_integral_sector(*Loop::make(linear, to_parallel(pid)));
}

bool stable_with(const Plant& plant, IdealPid pid, double factor) {
    const auto linear = *LinearPlant::make(plant);
    ParallelPid gains = to_parallel(pid);
    gains.Ki *= factor;
    return count_unstable_poles(*Loop::make(linear, gains)).stable();
}

TEST(IntegralSector, BothCriteriaAgreeWithHandCalculation) {
    // P = 1/(s + 1), C = Kp + Ki/s: G = Ki/(s (s + 1 + Kp)), Re G = -Ki/(w^2 + (1 + Kp)^2), least at 0; the circle
    // criterion holds up to Ki = (1 + Kp)^2, Popov's always (q = 1/(1 + Kp)).
    const Fopdt plant{.K = 1, .T = 1, .L = 0};
    const auto weak = judged(plant, {.Kp = 1, .Ti = 1 / 3.9});
    EXPECT_TRUE(weak.circle_criterion && weak.popov_criterion);
    EXPECT_EQ(weak.popov_q, 0);
    const auto strong = judged(plant, {.Kp = 1, .Ti = 1 / 4.1});
    EXPECT_FALSE(strong.circle_criterion);
    EXPECT_TRUE(strong.popov_criterion);
    const auto very_strong = judged(plant, {.Kp = 1, .Ti = 1e-3});
    EXPECT_FALSE(very_strong.circle_criterion);
    EXPECT_TRUE(very_strong.popov_criterion && very_strong.absolutely_stable());
    ASSERT_TRUE(very_strong.popov_q.has_value());
    for (double w = 1e-3; w < 1e4; w *= 1.1) {
        const std::complex<double> s{0, w}, G = 1e3 / (s * (s + 2.0));
        EXPECT_GT(((1.0 + s * *very_strong.popov_q) * G).real(), -1) << w;
    }
}

TEST(IntegralSector, PopovFailsWhereTheLinearLoopIsCloseToInstability) {
    // The linear loop is the limit of large amplitudes of every gain below one: at its own stability limit nothing can
    // be proved.
    const Fopdt plant{.K = 1, .T = 1, .L = 1};
    const double Ku_of_I = 0.8;
    for (const double share : {0.2, 0.5, 0.9, 0.99}) {
        const auto sector = judged(plant, {.Kp = 0.01, .Ti = 0.01 / (share * Ku_of_I)});
        EXPECT_TRUE(sector.stable_for_every_gain) << share;
        EXPECT_TRUE(sector.popov_criterion || !sector.circle_criterion) << share;
    }
    EXPECT_TRUE(judged(plant, {.Kp = 0.01, .Ti = 0.01 / (0.2 * Ku_of_I)}).absolutely_stable());
}

TEST(IntegralSector, FindsTheIntegralGainThatHoldsAnOscillatoryPlant) {
    // A lightly damped plant whose dead time turns the derivative action into negative damping and the integral action
    // into positive damping.
    const OscillatorySopdt plant{.K = 1, .T = 1, .zeta = 0.05, .L = 3.14159265};
    const IdealPid pid{.Kp = 0.01, .Ti = 0.1, .Td = 15};
    ASSERT_TRUE(stable_with(plant, pid, 1));
    const auto sector = judged(plant, pid);
    EXPECT_FALSE(sector.stable_without_integral);
    EXPECT_FALSE(sector.absolutely_stable() || sector.stable_for_every_gain);
    ASSERT_TRUE(sector.critical_gain.has_value());
    EXPECT_GT(*sector.critical_gain, 0);
    EXPECT_LT(*sector.critical_gain, 1);
    EXPECT_TRUE(stable_with(plant, pid, *sector.critical_gain * (1 + 1e-6)));
    EXPECT_FALSE(stable_with(plant, pid, *sector.critical_gain * (1 - 1e-6)));
}

TEST(IntegralSector, ANeutralLoopIsJudgedToo) {
    const Fopdt plant{.K = 1, .T = 1, .L = 0.5};
    const auto sector = judged(plant, {.Kp = 1.976, .Ti = 1.016, .Td = 0.1838});
    EXPECT_TRUE(sector.stable_without_integral && sector.circle_criterion);
}

}  // namespace
}  // namespace tunewright
