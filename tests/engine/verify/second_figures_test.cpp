// The second computation of a loop's figures against closed forms.
#include "engine/verify/second_figures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/verify/tolerance.h"

namespace tunewright::verify {
namespace {

constexpr double kPi = std::numbers::pi;

LinearPlant plant_of(const Plant& plant) { return std::move(*LinearPlant::make(plant)); }

TEST(SecondFigures, ALagWithASlowPiHasTheIntegralTiOverKp) {
    const double Kp = 0.5, Ti = 10;
    const auto second = second_figures(plant_of(Fopdt{.K = 2, .T = 10, .L = 3}), {.Kp = Kp, .Ki = Kp / Ti}, {});
    ASSERT_TRUE(second.unverified.empty());
    // y keeps its sign, so IAE = Ti/Kp; the second way claims 1e-6.
    EXPECT_NEAR(*second.performance.load.IAE, Ti / Kp, 1e-6 * Ti / Kp);
}

TEST(SecondFigures, ALagWithAPiThatCancelsItIsAFirstOrderLoop) {
    // L = Kp K/(T s) with Ti = T: y/r = 1/(tau s + 1), tau = T/(Kp K); e = exp(-t/tau).
    const double K = 2, T = 10, Kp = 1.5, tau = T / (Kp * K);
    const auto second = second_figures(plant_of(Fopdt{.K = K, .T = T, .L = 0}), {.Kp = Kp, .Ki = Kp / T}, {});
    const SetpointPerformance& r = second.performance.setpoint;
    EXPECT_NEAR(*r.IAE, tau, 1e-7 * tau);
    EXPECT_NEAR(*r.ISE, tau / 2, 1e-7 * tau);
    EXPECT_NEAR(*r.ITAE, tau * tau, 1e-7 * tau * tau);
    EXPECT_NEAR(*r.rise_time, tau * std::log(9.0), 1e-7 * tau);
    EXPECT_NEAR(*r.rise_time_5_95, tau * std::log(19.0), 1e-7 * tau);
    EXPECT_NEAR(*r.settling_time, tau * std::log(50.0), 1e-7 * tau);
    EXPECT_NEAR(*r.overshoot_percent, 0, 1e-7);
    EXPECT_DOUBLE_EQ(*r.first_move, Kp);
    EXPECT_NEAR(*r.TV, Kp + (Kp - 1 / K), 1e-8);
    EXPECT_NEAR(*second.robustness.phase_margin_deg, 90, 1e-9);
    EXPECT_NEAR(*second.robustness.gain_crossover, 1 / tau, 1e-9 / tau);
    EXPECT_NEAR(*second.robustness.delay_margin, tau * kPi / 2, 1e-9 * tau);
    EXPECT_FALSE(second.robustness.gain_margin);
    EXPECT_NEAR(*second.robustness.Ms, 1, 1e-12);
    EXPECT_FALSE(second.robustness.omega_Ms) << "a limit at infinity";
}

TEST(SecondFigures, ALagWithAPControllerHasNoOvershootAndAnErrorThatStays) {
    const double Kp = 3;
    const auto second = second_figures(plant_of(Fopdt{.K = 1, .T = 1, .L = 0}), {.Kp = Kp}, {});
    EXPECT_EQ(*second.performance.setpoint.overshoot_percent, 0);
    EXPECT_FALSE(second.performance.setpoint.IAE);
    EXPECT_FALSE(second.performance.load.IAE);
    EXPECT_NEAR(*second.performance.load.peak, 1 / (1 + Kp), 1e-8);
    EXPECT_NEAR(*second.robustness.Mt, Kp / (1 + Kp), 1e-11);
    EXPECT_EQ(*second.robustness.omega_Mt, 0);
}

TEST(SecondFigures, AnIntegratorWithDeadTimeHasItsTextbookMargins) {
    // L = k e^(-s)/s.
    const double k = 0.5;
    const auto second = second_figures(plant_of(Ipdt{.K = 1, .L = 1}), {.Kp = k}, {});
    const Robustness& r = second.robustness;
    EXPECT_NEAR(*r.gain_margin, kPi / (2 * k), 1e-10);
    EXPECT_NEAR(*r.phase_crossover, kPi / 2, 1e-10);
    EXPECT_NEAR(*r.phase_margin_deg, 90 - k * 180 / kPi, 1e-9);
    EXPECT_NEAR(*r.delay_margin, (kPi / 2 - k) / k, 1e-10);
    EXPECT_NEAR(*r.gain_crossover, k, 1e-11);
}

TEST(SecondFigures, AnIntegratorWithPiIsASecondOrderLoop) {
    // y/r = Ki/(s^2 + Kp s + Ki) with b = 0; y/d = s/(s^2 + Kp s + Ki).
    const double omega = 2, zeta = 0.4, Kp = 2 * zeta * omega, Ki = omega * omega;
    const auto second = second_figures(plant_of(Ipdt{.K = 1, .L = 0}), {.Kp = Kp, .Ki = Ki, .b = 0}, {});
    const double root = std::sqrt(1 - zeta * zeta);
    EXPECT_NEAR(*second.performance.setpoint.overshoot_percent, 100 * std::exp(-kPi * zeta / root), 1e-6);
    EXPECT_EQ(*second.performance.setpoint.first_move, 0);
    EXPECT_NEAR(*second.performance.load.ISE, 1 / (2 * Ki * Kp), 1e-8);
    EXPECT_NEAR(*second.performance.load.peak, std::exp(-zeta * std::acos(zeta) / root) / omega, 1e-8);
    // |e| over half-periods is a geometric series: IAE = IE coth(pi zeta/(2 root)), IE = 1/Ki.
    const double q = std::exp(-kPi * zeta / root);
    EXPECT_NEAR(*second.performance.load.IAE, (1 + q) / (1 - q) / Ki, 1e-7);
}

TEST(SecondFigures, NoiseOfASlowLoopIsThatOfTheProportionalGain) {
    EvaluateOptions options;
    options.noise = NoiseOptions{.std = 0.1, .sample_time = 1e-3};
    const auto second = second_figures(plant_of(Fopdt{.K = 1e-6, .T = 1, .L = 0}), {.Kp = 4}, options);
    ASSERT_TRUE(second.performance.noise);
    EXPECT_NEAR(*second.performance.noise->gain, 4, 1e-4);
    EXPECT_NEAR(*second.performance.noise->u_std, 0.4, 1e-5);
}

TEST(SecondFigures, AnUnstableLoopHasNoFigures) {
    const auto second = second_figures(plant_of(Ipdt{.K = 1, .L = 1}), {.Kp = 1.6}, {});
    EXPECT_FALSE(second.robustness.stable) << "stable up to pi/2";
    EXPECT_FALSE(second.robustness.Ms);
    EXPECT_TRUE(second_figures(plant_of(Ipdt{.K = 1, .L = 1}), {.Kp = 1.5}, {}).robustness.stable);
}

TEST(SecondFigures, ALimitThatIsReachedHasNoSecondWay) {
    EvaluateOptions options;
    options.actuator = ActuatorLimits{-1.5, 1.5};
    const LinearPlant plant = plant_of(Fopdt{.K = 1, .T = 1, .L = 0});
    EXPECT_TRUE(second_figures(plant, {.Kp = 2, .Ki = 2}, options).lacks("performance/setpoint"));
    EXPECT_FALSE(second_figures(plant, {.Kp = 0.9, .Ki = 0.9}, options).lacks("performance/setpoint"));
}

/// Both ways agree on loops with every filter, weights and a lag of the set point.
TEST(SecondFigures, AgreeWithTheEvaluationOnRandomLoops) {
    std::mt19937 random(7);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const std::array filters = {FilterType::none, FilterType::derivative, FilterType::measurement_first_order,
                                FilterType::measurement_second_order};
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
        const double T = std::exp(uniform(-2, 2)), L = i % 5 == 0 ? 0 : T * std::exp(uniform(-2, 1));
        const double Kp = uniform(0.1, 0.5) * T / (L + 0.3 * T), Ti = uniform(0.8, 2) * (T + 0.3 * L);
        const FilterType filter = filters[static_cast<std::size_t>(i) % 4];
        const double Td = filter == FilterType::none ? 0 : uniform(0, 0.3) * (L + 0.1 * T);
        IdealPid pid{.Kp = Kp, .Ti = Ti, .Td = Td, .b = uniform(0, 1), .setpoint_lag = i % 3 == 0 ? T / 3 : 0};
        if (filter != FilterType::none) pid.filter = {filter, 0.1 * Td + 0.01 * T};
        const Plant plant =
            i % 2 == 0 ? Plant(Fopdt{.K = 1, .T = T, .L = L}) : Plant(Sopdt{.K = 1, .T1 = T, .T2 = T / 4, .L = L});
        const auto first = evaluate(PlantModel(plant), Controller(pid), {});
        ASSERT_TRUE(first);
        const Robustness& r = first->robustness;
        const auto second = second_figures(plant_of(plant), gains(Controller(pid)), {}, {r.omega_Ms, r.omega_Mt});
        ASSERT_TRUE(second.unverified.empty());
        ASSERT_EQ(r.stable, second.robustness.stable);
        const auto expect = [&](const char* name, const Figure& a, const Figure& b, const IndexErrors& stated = {}) {
            ASSERT_EQ(a.has_value(), b.has_value()) << name << " of loop " << i;
            if (a) {
                EXPECT_LE(difference(name, *a, *b), *largest_difference(name, stated)) << name << " of loop " << i;
            }
            ++compared;
        };
        expect("Ms", r.Ms, second.robustness.Ms);
        expect("Mt", r.Mt, second.robustness.Mt);
        expect("Mks", r.Mks, second.robustness.Mks);
        expect("omega_Ms", r.omega_Ms, second.robustness.omega_Ms);
        expect("gain_margin", r.gain_margin, second.robustness.gain_margin);
        expect("phase_margin_deg", r.phase_margin_deg, second.robustness.phase_margin_deg);
        expect("delay_margin", r.delay_margin, second.robustness.delay_margin);
        const SetpointPerformance &a = first->performance.setpoint, &b = second.performance.setpoint;
        expect("IAE", a.IAE, b.IAE, first->verification.setpoint_errors);
        expect("ITAE", a.ITAE, b.ITAE, first->verification.setpoint_errors);
        expect("TV", a.TV, b.TV, first->verification.setpoint_errors);
        expect("overshoot_percent", a.overshoot_percent, b.overshoot_percent);
        expect("settling_time", a.settling_time, b.settling_time);
        expect("first_move", a.first_move, b.first_move);
        expect("IAE", first->performance.load.IAE, second.performance.load.IAE, first->verification.load_errors);
        expect("peak", first->performance.load.peak, second.performance.load.peak);
    }
    EXPECT_GT(compared, 800);
}

}  // namespace
}  // namespace tunewright::verify
