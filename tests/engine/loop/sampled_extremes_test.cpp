// Sampled loops at the limits of the allowed requests: no crash, no NaN, and agreement with theory.
#include <gtest/gtest.h>

#include <stop_token>
#include <tuple>

#include "engine/evaluation/evaluate_sampled.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "tests/engine/loop/sampled_cases.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using namespace test;

void expect_numbers(const Figure& figure, const char* name) {
    if (figure) {
        EXPECT_TRUE(std::isfinite(*figure)) << name;
    } else {
        EXPECT_FALSE(figure.why.empty()) << name;
    }
}

/// Checks that all figures of the loop are numbers or have a reason.
DeviceLoop evaluated(const Plant& plant, const SampledPid& law, const ProgramLimits& limits = {},
                     bool horizon = false) {
    EvaluateOptions options;
    if (horizon) options.horizon = 30 * law.Ts;
    const auto built = evaluate_sampled(subject_of(plant), law, limits, options);
    EXPECT_TRUE(built);
    const Robustness& r = built->robustness;
    expect_numbers(r.Ms, "Ms"), expect_numbers(r.Mt, "Mt"), expect_numbers(r.Mks, "Mks");
    expect_numbers(r.gain_margin, "gain margin"), expect_numbers(r.phase_margin_deg, "phase margin");
    expect_numbers(r.delay_margin, "delay margin"), expect_numbers(r.gain_margin_low, "lower gain margin");
    const SetpointPerformance& s = built->performance.setpoint;
    expect_numbers(s.IAE, "IAE"), expect_numbers(s.TV, "TV"), expect_numbers(s.overshoot_percent, "overshoot");
    const LoadPerformance& l = built->performance.load;
    expect_numbers(l.IAE, "load IAE"), expect_numbers(l.TV, "load TV"), expect_numbers(l.peak, "peak");
    if (built->responses) {
        for (const Trace* trace : {&built->responses->setpoint, &built->responses->load})
            for (std::size_t i = 0; i < trace->t.size(); ++i) EXPECT_TRUE(std::isfinite(trace->y[i] + trace->u[i]));
    }
    return *built;
}

StabilityCount count(const Plant& plant, const SampledPid& law) {
    const LinearPlant linear = *LinearPlant::make(plant);
    return count_unstable_poles(SampledLoop(linear, law));
}

TEST(SampledExtremes, ADeadTimeBeyondCountingIsRefusedWithTheSampleTime) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    for (const auto& [L, Ts, delay] : {std::tuple{1e15, 0.5, 0.0}, {3.0, 1e-9, 0.0}, {3.0, 0.5, 3e9}}) {
        const auto built = evaluate_sampled(subject_of(Plant(Fopdt{.K = 2, .T = 10, .L = L})),
                                            {.gains = {.Kp = 1}, .Ts = Ts, .computation_delay = delay}, {}, {});
        ASSERT_FALSE(built) << L;
        EXPECT_EQ(built.error().kind, ErrorKind::invalid_argument);
        EXPECT_EQ(built.error().where, "implement/sample_time");
    }
    EXPECT_EQ(in_samples(1e300, 1e-300).whole, 1'000'000'000);
    EXPECT_TRUE(evaluated(plant, {.gains = {.Kp = 1, .Ki = 0.02}, .Ts = 3e-3}).robustness.stable);
}

TEST(SampledExtremes, ALagOfRoundingNeitherFillsTheMemoryNorKeepsAStopWaiting) {
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 2, .T = 1e-15, .L = 3});
    const SampledPid law{.gains = {.Kp = 0.01, .Ki = 1e-7}, .Ts = 0.5};
    const StepResponse response = simulate_sampled(plant, law, {}, {1, 0}, {.max_samples = 20000});
    EXPECT_LT(response.nodes.size(), 1'100'000u);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(simulate_sampled(plant, law, {}, {1, 0}, {.stop = stop.get_token()}).settles);
}

TEST(SampledExtremes, ASampleTimeOfAThousandLags) {
    // y reaches K u before the next sample: z = -K Kp for a proportional law, -(K Ki Ts - 1) for a pure integral one.
    const DeviceLoop built = evaluated(Fopdt{.K = 0.5, .T = 1, .L = 3}, {.gains = {.Kp = 1}, .Ts = 1000}, {}, true);
    EXPECT_TRUE(built.robustness.stable);
    EXPECT_NEAR(*built.robustness.Ms, 2, 1e-9);  // 1/(1 - 0.5) at z = -1
    EXPECT_NEAR(*built.robustness.gain_margin, 2, 1e-9);
    EXPECT_FALSE(count(Fopdt{.K = 0.5, .T = 1, .L = 3}, {.gains = {.Kp = 2.1}, .Ts = 1000}).stable());
    const DeviceLoop integral = evaluated(Fopdt{.K = 0.5, .T = 1}, {.gains = {.Ki = 0.002}, .Ts = 1000});
    EXPECT_TRUE(integral.robustness.stable);
    EXPECT_NEAR(*integral.performance.setpoint.IAE, 1, 1e-5);  // deadbeat: as for one lag
    // e^1000 overflows: the loop is unstable, whatever the gain.
    for (const double Kp : {-3.0, 0.001, 2.0})
        EXPECT_FALSE(evaluated(Fopdt{.K = 1, .T = -1}, {.gains = {.Kp = Kp}, .Ts = 1000}).robustness.stable) << Kp;
}

TEST(SampledExtremes, ASampleTimeOfATenThousandthOfALag) {
    const SampledPid law{.gains = {.Kp = 0.5, .Ki = 0.5}, .Ts = 1e-4};
    const DeviceLoop built = evaluated(Fopdt{.K = 1, .T = 1, .L = 1}, law);
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 1});
    const StepResponse load = simulate_linear(plant, law.gains, {0, 1}, {});
    EXPECT_NEAR(*built.performance.load.IAE, integral_of_absolute_error(load.nodes, 0, load.error_integral_final),
                2e-4);
    // Compared with its gain margin: there stability is lost.
    for (const double share : {0.999, 1.001}) {
        SampledPid more = law;
        more.gains.Kp *= share * *built.robustness.gain_margin;
        more.gains.Ki *= share * *built.robustness.gain_margin;
        EXPECT_EQ(count(Fopdt{.K = 1, .T = 1, .L = 1}, more).stable(), share < 1);
    }
}

TEST(SampledExtremes, ADeadTimeOfFiveThousandSamples) {
    for (const double T : {0.5, 5.0, 50.0}) {
        const DeviceLoop lag = evaluated(Fopdt{.K = 1, .T = T, .L = 5}, {.gains = {.Kp = 0.3, .Ki = 0.08}, .Ts = 1e-3});
        EXPECT_TRUE(lag.robustness.stable);
    }
    // y = K u(t - L): |L| = K Kp at all frequencies.
    const DeviceLoop gain = evaluated(Fopdt{.K = 1, .T = 0, .L = 5}, {.gains = {.Kp = 0.5}, .Ts = 1e-3}, {}, true);
    EXPECT_TRUE(gain.robustness.stable);
    EXPECT_NEAR(*gain.robustness.Ms, 2, 1e-9);
    EXPECT_NEAR(*gain.robustness.gain_margin, 2, 1e-9);
    EXPECT_NEAR(*gain.robustness.Mks, 1, 1e-9);
    const DeviceLoop integral =
        evaluated(Fopdt{.K = 1, .T = 0, .L = 5}, {.gains = {.Kp = 0.3, .Ki = 0.08}, .Ts = 1e-3});
    EXPECT_TRUE(integral.robustness.stable);
    EXPECT_FALSE(count(Fopdt{.K = 1, .T = 0, .L = 5}, {.gains = {.Kp = 1.01}, .Ts = 1e-3}).stable());
    evaluated(TransferFunction{.num = {0.5, 1}, .den = {1, 1}, .L = 5}, {.gains = {.Kp = 0.4, .Ki = 0.08}, .Ts = 1e-3});
    evaluated(Ipdt{.K = 1, .L = 5}, {.gains = {.Kp = 0.05, .Ki = 0.001}, .Ts = 1e-3});
}

TEST(SampledExtremes, SwingsFasterThanTheSamples) {
    for (const double zeta : {1e-2, 1e-3, 1e-4})
        for (const double fold : {0.3, 0.97, 1.0, 2.0, 3.3, 4.0}) {
            const double omega = 2 * std::numbers::pi * fold;  // Ts = 1
            const Plant plant = Zpk{.K = omega * omega,
                                    .zeros = {},
                                    .poles = {{-zeta * omega, omega}, {-zeta * omega, -omega}, -0.3},
                                    .L = 0.3};
            const SampledPid law{.gains = {.Kp = 0.01, .Ki = 0.002}, .Ts = 1};
            const DeviceLoop built = evaluated(plant, law);
            const auto own = [&](const SampledPid& l) {
                return OwnLoop(
                    OwnPlant({omega * omega}, with_roots({{-zeta * omega, omega}, {-zeta * omega, -omega}, -0.3}, 1)),
                    0.3, l);
            };
            double largest = 0;
            for (const auto z : own(law).eigenvalues()) largest = std::max(largest, std::abs(z));
            EXPECT_EQ(built.robustness.stable, largest < 1) << zeta << ' ' << fold << ' ' << largest;
            if (!built.robustness.stable) continue;
            const auto pulse = pulse_response_of(own(law), 400000, 1);
            ASSERT_TRUE(pulse);
            if (pulse->S.size() > 6000) continue;
            EXPECT_NEAR(*built.robustness.Ms / peaks_of(*pulse).S, 1, 1e-6) << zeta << ' ' << fold;
        }
}

TEST(SampledExtremes, DoubleIntegrators) {
    const Plant plant = TransferFunction{.num = {1}, .den = {1, 0, 0}};
    for (const double Ts : {1e-3, 0.05, 0.5}) {
        const SampledPid law{.gains = {.Kp = 0.3, .Ki = 0.02, .Kd = 0.8}, .Ts = Ts};
        EXPECT_TRUE(evaluated(plant, law).robustness.stable);
        EXPECT_FALSE(count(plant, {.gains = {.Kp = 0.3, .Ki = 0.02}, .Ts = Ts}).stable());
    }
    evaluated(TransferFunction{.num = {1}, .den = {1, 0, 0, 0}},
              {.gains = {.Kp = 0.3, .Ki = 0.02, .Kd = 0.8}, .Ts = 0.1});
}

TEST(SampledExtremes, APoleExactlyOnTheCircle) {
    const auto on_it = [](const Plant& plant, const SampledPid& law) { return count(plant, law).on_the_boundary; };
    // For an integrator, z - 1 + K Kp Ts: at -1, at 0 (deadbeat) and at 1.
    EXPECT_TRUE(on_it(Ipdt{.K = 1}, {.gains = {.Kp = 2}, .Ts = 1}));
    EXPECT_TRUE(count(Ipdt{.K = 1}, {.gains = {.Kp = 1}, .Ts = 1}).stable());
    const DeviceLoop deadbeat = evaluated(Ipdt{.K = 1}, {.gains = {.Kp = 1}, .Ts = 1});
    EXPECT_NEAR(*deadbeat.robustness.Ms, 2, 1e-12);  // S = 1 - 1/z
    EXPECT_NEAR(*deadbeat.performance.setpoint.IAE, 0.5, 1e-9);
    // Kp = -1/K: 1 + L = 0 at z = 1.
    EXPECT_FALSE(count(Fopdt{.K = 2, .T = 1, .L = 0.3}, {.gains = {.Kp = -0.5}, .Ts = 0.2}).stable());
    EXPECT_TRUE(count(Fopdt{.K = 2, .T = 1, .L = 0.3}, {.gains = {.Kp = -0.4999}, .Ts = 0.2}).stable());
    EXPECT_FALSE(count(Fopdt{.K = 2, .T = 1, .L = 0.3}, {.gains = {.Kp = -0.5001}, .Ts = 0.2}).stable());
    // Half an oscillation, or a whole one, between samples: the input moves only one of the two states; the other
    // continues freely.
    for (const double swings : {0.5, 1.0}) {
        const double omega = 2 * std::numbers::pi * swings;
        const Plant undamped = TransferFunction{.num = {omega * omega}, .den = {1, 0, omega * omega}};
        EXPECT_FALSE(count(undamped, {.gains = {.Kp = 0.3}, .Ts = 1}).stable()) << swings;
        evaluated(undamped, {.gains = {.Kp = 0.3}, .Ts = 1});
        EXPECT_FALSE(count(undamped, {.gains = {.Kp = 0.1, .Ki = 0.1}, .Ts = 1}).stable()) << swings;
    }
    // At other sample times an undamped plant can be stabilised.
    const Plant undamped = TransferFunction{.num = {1}, .den = {1, 0, 1}};
    const SampledPid law{.gains = {.Kp = 0.2, .Ki = 0.1, .Kd = 0.6}, .Ts = 0.3};
    double largest = 0;
    for (const auto z : OwnLoop(OwnPlant({1}, {1, 0, 1}), 0, law).eigenvalues())
        largest = std::max(largest, std::abs(z));
    EXPECT_LT(largest, 1);
    const DeviceLoop built = evaluated(undamped, law);
    EXPECT_TRUE(built.robustness.stable);
    const auto pulse = pulse_response_of(OwnLoop(OwnPlant({1}, {1, 0, 1}), 0, law), 20000, 0);
    EXPECT_NEAR(*built.robustness.Mks / peaks_of(*pulse).CS, 1, 1e-7);
}

// Tf = Ts/2 with the forward rule: D alone oscillates in sign forever, but within the loop it can be stabilised.
TEST(SampledExtremes, AFilterWithItsPoleAtMinusOne) {
    SampledPid law{.gains = {.Kp = 0.5, .Ki = 0.2, .Kd = 0.1, .filter = {FilterType::derivative, 0.25}}, .Ts = 0.5};
    law.derivative = DerivativeRule::filtered_forward;
    const OwnPlant own({1}, {1, 1});
    double largest = 0;
    for (const auto z : OwnLoop(own, 0, law).eigenvalues()) largest = std::max(largest, std::abs(z));
    const DeviceLoop built = evaluated(Fopdt{.K = 1, .T = 1}, law);
    EXPECT_EQ(built.robustness.stable, largest < 1) << largest;
    for (const double Kd : {-0.1, 0.02}) {
        law.gains.Kd = Kd;
        largest = 0;
        for (const auto z : OwnLoop(own, 0, law).eigenvalues()) largest = std::max(largest, std::abs(z));
        const DeviceLoop other = evaluated(Fopdt{.K = 1, .T = 1}, law);
        EXPECT_EQ(other.robustness.stable, largest < 1) << largest;
        const auto pulse = pulse_response_of(OwnLoop(own, 0, law), 100000, 0);
        EXPECT_EQ(pulse.has_value(), largest < 1);
        if (!pulse) continue;
        EXPECT_NEAR(*other.robustness.Mks / peaks_of(*pulse).CS, 1, 1e-6);
        EXPECT_NEAR(*other.robustness.Ms / peaks_of(*pulse).S, 1, 1e-6);
    }
}

// A zero at s = 0 cancels the integral: u drifts, and the pole at z = 1 is not controllable.
TEST(SampledExtremes, AZeroAtTheOriginUnderAnIntegral) {
    const Plant plant = TransferFunction{.num = {1, 0}, .den = {1, 2, 1}};
    EXPECT_FALSE(count(plant, {.gains = {.Kp = 0.5, .Ki = 0.3}, .Ts = 0.2}).stable());
    const DeviceLoop proportional = evaluated(plant, {.gains = {.Kp = 0.5}, .Ts = 0.2});
    EXPECT_TRUE(proportional.robustness.stable);
    evaluated(plant, {.gains = {.Kp = 0.5, .Ki = 0.3}, .Ts = 0.2});
}

TEST(SampledExtremes, LawsWithoutAPart) {
    const Plant plant = Sopdt{.K = 2, .T1 = 1, .T2 = 0.5, .L = 0.3},
                negative = Sopdt{.K = -2, .T1 = 1, .T2 = 0.5, .L = 0.3};
    for (const ParallelPid& g : {ParallelPid{.Kp = 0.3}, ParallelPid{.Ki = 0.2}, ParallelPid{.Kp = 0.3, .Kd = 0.1},
                                 ParallelPid{.Ki = 0.2, .Kd = 0.1}, ParallelPid{.Kd = 0.1}, ParallelPid{}}) {
        SampledPid law{.gains = g, .Ts = 0.1};
        const DeviceLoop one = evaluated(plant, law);
        EXPECT_TRUE(one.robustness.stable);
        law.gains.Kp *= -1, law.gains.Ki *= -1, law.gains.Kd *= -1;
        const DeviceLoop mirrored = evaluated(negative, law);
        EXPECT_EQ(*mirrored.robustness.Ms, *one.robustness.Ms);
        if (one.performance.load.IAE) {
            EXPECT_NEAR(*mirrored.performance.load.IAE, *one.performance.load.IAE, 1e-12);
        }
        // An integral with the wrong sign is never stable.
        if (g.Ki != 0) {
            EXPECT_FALSE(evaluated(plant, law).robustness.stable);
        }
    }
}

TEST(SampledExtremes, LimitsThatAreNeverReachedOrNeverLeft) {
    const Plant plant = Fopdt{.K = 1, .T = 1, .L = 0.2};
    const SampledPid law{.gains = {.Kp = 0.5, .Ki = 0.5}, .Ts = 0.01};
    const auto limited = [](double limit) { return ProgramLimits{.output = ActuatorLimits{-limit, limit}}; };
    EXPECT_EQ(*evaluated(plant, law, limited(1e9)).performance.load.IAE, *evaluated(plant, law).performance.load.IAE);
    EXPECT_FALSE(evaluated(plant, law, limited(0.2)).performance.load.IAE);
    EXPECT_FALSE(evaluated(Ipdt{.K = 1, .L = 0.2}, law, limited(0.2)).performance.load.IAE);
    EXPECT_FALSE(evaluated(plant, law, limited(1e-12)).performance.load.IAE);
    ProgramLimits coarse = limited(0.5);
    coarse.u_resolution = 0.3, coarse.y_resolution = 0.2, coarse.dead_band = 0.1;
    evaluated(plant, law, coarse);
    evaluated(Ipdt{.K = 1, .L = 0.2}, law, coarse);
}

}  // namespace
}  // namespace tunewright
