// Traces over frequency: smooth curves that include the marked frequencies and count the turns of the dead time; and
// peaks between the grid points when a dead time causes ripples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/loop/loop.h"

namespace tunewright {
namespace {

bool holds(const std::vector<double>& omega, const Figure& wanted) {
    return std::ranges::any_of(omega, [&](double w) { return std::abs(w / *wanted - 1) < 1e-12; });
}

TEST(FrequencyTraces, FollowTheTurnsOfADeadTimeUntilTheyCannotBeSeen) {
    for (const double L : {0.05, 0.5, 2.0, 20.0}) {
        const double Ti = 1 + 0.3 * L;
        const Plant plant = Fopdt{.K = 1, .T = 1, .L = L};
        const auto answer = evaluate(PlantModel(plant), IdealPid{.Kp = L < 1 ? 0.5 / L : 0.3, .Ti = Ti}, {});
        ASSERT_TRUE(answer && answer->robustness.stable);
        const FrequencyTraces& f = *answer->frequency;
        ASSERT_LE(f.omega.size(), 400u);
        EXPECT_TRUE(holds(f.omega, answer->robustness.omega_Ms)) << "L " << L;
        EXPECT_TRUE(holds(f.omega, answer->robustness.gain_crossover));
        EXPECT_NEAR(*std::ranges::max_element(f.S_abs), *answer->robustness.Ms, 1e-9);
        for (std::size_t i = 1; i < f.omega.size(); ++i) {
            ASSERT_GT(f.omega[i], f.omega[i - 1]);
            const double gain = std::hypot(f.L_re[i], f.L_im[i]), w = f.omega[i];
            // The distance of a chord from its arc: less than a pixel if the unit circle is 100 wide.
            const double turn = (f.L_phase_deg[i] - f.L_phase_deg[i - 1]) * std::numbers::pi / 180;
            if (gain > 0.02 && gain < 4) {
                EXPECT_LT(gain * (1 - std::cos(turn / 2)), 0.01) << "L " << L << " omega " << w;
            }
            // The phase is that of plant and controller, including whole turns.
            const double exact = -w * L - std::atan(w) - std::numbers::pi / 2 + std::atan(w * Ti);
            EXPECT_NEAR(f.L_phase_deg[i], exact * 180 / std::numbers::pi, 1e-6);
        }
        EXPECT_LT(std::hypot(f.L_re.back(), f.L_im.back()), 0.01);
    }
}

// If the dead time causes ripples in |C S|, the grid, which follows S, misses the highest one.
TEST(Peaks, OfCSAreThoseOfADenseGridWhereADeadTimeRipplesThem) {
    std::mt19937 chance(3);
    const auto between = [&](double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>()(chance));
    };
    EvaluateOptions figures;
    figures.points = 0;
    int looked_at = 0;
    for (int i = 0; i < 200; ++i) {
        const double L = between(0.05, 5), Kp = between(0.1, 0.6) / std::max(L, 0.3), Tf = between(0.005, 0.3);
        const IdealPid pid{.Kp = Kp,
                           .Ti = between(0.4, 2),
                           .Td = between(0.01, 0.5) * L,
                           .filter = {FilterType::measurement_second_order, Tf}};
        const Plant plant = Fopdt{.K = 1, .T = 1, .L = L};
        const auto linear = LinearPlant::make(plant);
        const auto loop = Loop::make(*linear, to_parallel(pid));
        const auto answer = evaluate(PlantModel(plant), pid, figures);
        if (!answer || !answer->robustness.stable) continue;
        ++looked_at;
        double dense = 0;
        const double step = std::min(0.02 / L, 0.02 / Tf);
        for (double omega = step; omega < 20 / Tf; omega += step) dense = std::max(dense, std::abs(loop->at(omega).CS));
        EXPECT_GE(*answer->robustness.Mks, dense * (1 - 1e-9)) << "loop " << i;
    }
    EXPECT_GT(looked_at, 80);
    const auto known = evaluate(
        PlantModel(Plant(Fopdt{.K = 1, .T = 1, .L = 0.5})),
        IdealPid{.Kp = 0.5, .Ti = 0.5 / 1.2, .Td = 0.1, .filter = {FilterType::measurement_second_order, 0.01}}, {});
    EXPECT_NEAR(*known->robustness.Mks, 5.19, 0.01);
}

}  // namespace
}  // namespace tunewright
