// Noise gain compared with exact sums in the time domain, a seeded random run and closed forms.
#include "engine/loop/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

LinearPlant noisy_plant(const Plant& plant) {
    auto result = LinearPlant::make(plant);
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return *result;
}

double gain_of(const LinearPlant& plant, const ParallelPid& gains, double Ts) {
    const auto loop = Loop::make(plant, gains);
    EXPECT_TRUE(loop.has_value());
    const auto gain = noise_gain(*loop, Ts);
    EXPECT_TRUE(gain.has_value());
    return gain.value_or(0);
}

/// A loop in tiny steps dt that divide L and Ts: the first-order plant K/(T s + 1) (T = 0: a gain) with PI, or PID with
/// the second-order filter, measurement y + n. The lags are exact for inputs constant over dt.
class PlainLoop {
public:
    PlainLoop(double K, double T, double L, const ParallelPid& c, double dt)
        : K_(K), decay_(T > 0 ? std::exp(-dt / T) : 0), c_(c), dt_(dt) {
        delay_.assign(static_cast<std::size_t>(std::lround(L / dt)), 0.0);
        if (const double Tf = c.filter.Tf; Tf > 0) {
            const std::vector<double> A = {0, dt, 0, -2 * dt / (Tf * Tf), -2 * dt / Tf, 2 * dt / (Tf * Tf), 0, 0, 0};
            filter_ = matrix_exponential(A, 3);
        }
    }
    /// u over the next dt for noise n.
    double step(double n) {
        const bool filtered = !filter_.empty();
        const double measured = y_ + n, used = filtered ? yf_ : measured;
        const double u = -c_.Kp * used - c_.Kd * slope_ - I_;
        double v = u;
        if (!delay_.empty()) {
            v = delay_[at_];
            delay_[at_] = u;
            at_ = (at_ + 1) % delay_.size();
        }
        y_ = decay_ * y_ + (1 - decay_) * K_ * v;
        I_ += c_.Ki * dt_ * used;
        if (filtered) {
            const double yf = filter_[0] * yf_ + filter_[1] * slope_ + filter_[2] * measured;
            slope_ = filter_[3] * yf_ + filter_[4] * slope_ + filter_[5] * measured;
            yf_ = yf;
        }
        return u;
    }

private:
    double K_, decay_;
    ParallelPid c_;
    double dt_;
    std::vector<double> delay_, filter_;
    std::size_t at_ = 0;
    double y_ = 0, I_ = 0, yf_ = 0, slope_ = 0;
};

/// Exact up to dt: u = sum of n_k times the response h to one sample's pulse, so the mean of its variance over a sample
/// interval is the integral of h^2 over Ts.
double by_pulse_response(double K, double T, double L, const ParallelPid& c, double Ts, double dt, double horizon) {
    const auto run = [&](double step) {
        PlainLoop loop(K, T, L, c, step);
        const int pulse = static_cast<int>(std::lround(Ts / step)), n = static_cast<int>(horizon / step);
        double sum = 0, before = 0;
        for (int k = 0; k < n; ++k) {
            const double u = loop.step(k < pulse ? 1 : 0);
            sum += u * u * step;
            before = u;
        }
        EXPECT_LT(std::abs(before), 1e-5);
        return sum / Ts;
    };
    return std::sqrt(2 * run(dt / 2) - run(dt));  // the error is proportional to dt
}

TEST(NoiseGain, IsKpForAPController) {
    const auto plant = noisy_plant(Fopdt{.K = 1e-9, .T = 1, .L = 0.3});
    for (const double Ts : {1e-4, 0.1, 5.0}) EXPECT_NEAR(gain_of(plant, {.Kp = -2.5}, Ts), 2.5, 1e-8);
}

TEST(NoiseGain, MatchesTheClosedFormOfAFirstOrderLoop) {
    // P on K/(T s + 1) without dead time: the pulse response is Kp (1 - a) + Kp a e^(-t p) and so on with a = K Kp p0,
    // pole p = (1 + K Kp)/T. Integral of its square in closed form.
    for (const double Ts : {0.01, 0.3, 2.0, 40.0}) {
        const double K = 1, T = 2, Kp = 4, p = (1 + K * Kp) / T, end = Kp / (1 + K * Kp), jump = Kp - end;
        // During the pulse u = end + jump e^(-p t); afterwards -jump (1 - e^(-p Ts)) e^(-p t).
        const double x = 1 - std::exp(-p * Ts);
        const double during =
            end * end * Ts + 2 * end * jump * x / p + jump * jump * (1 - std::exp(-2 * p * Ts)) / (2 * p);
        const double after = jump * jump * x * x / (2 * p);
        const double expected = std::sqrt((during + after) / Ts);
        EXPECT_NEAR(gain_of(noisy_plant(Fopdt{.K = K, .T = T, .L = 0}), {.Kp = Kp}, Ts) / expected, 1, 1e-5) << Ts;
    }
}

TEST(NoiseGain, MatchesThePulseResponseWithDeadTimeAndFilters) {
    const ParallelPid pi{.Kp = 0.9, .Ki = 0.8};
    const ParallelPid pid{.Kp = 1.1, .Ki = 0.9, .Kd = 0.4, .filter = {FilterType::measurement_second_order, 0.1}};
    for (const ParallelPid& c : {pi, pid})
        for (const double Ts : {0.02, 0.4, 1.0, 3.0})
            for (const double L : {0.2, 1.0}) {
                const double expected = by_pulse_response(1, 1, L, c, Ts, 1e-3, 60);
                EXPECT_NEAR(gain_of(noisy_plant(Fopdt{.K = 1, .T = 1, .L = L}), c, Ts) / expected, 1, 2e-4)
                    << Ts << " " << L << " " << c.Kd;
            }
}

TEST(NoiseGain, IntegratesTheEchoesOfANeutralLoopInClosedForm) {
    // PI on a pure dead time: |C S| never stops oscillating; q = 0.6.
    for (const double Ts : {0.05, 0.5, 1.0, 2.5}) {
        const ParallelPid c{.Kp = 0.6, .Ki = 0.3};
        const double expected = by_pulse_response(1, 0, 1, c, Ts, 1e-3, 80);
        EXPECT_NEAR(gain_of(noisy_plant(Fopdt{.K = 1, .T = 0, .L = 1}), c, Ts) / expected, 1, 2e-4) << Ts;
    }
}

TEST(NoiseGain, HoldsForANearlyUndampedLoop) {
    // 2 % below the ultimate gain pi/2 of an integral controller on e^(-s): a narrow peak of |C S|.
    const ParallelPid c{.Ki = 0.98 * std::numbers::pi / 2};
    const double expected = by_pulse_response(1, 0, 1, c, 0.5, 5e-4, 1200);
    EXPECT_NEAR(gain_of(noisy_plant(Fopdt{.K = 1, .T = 0, .L = 1}), c, 0.5) / expected, 1, 1e-3);
}

TEST(NoiseGain, IsWhatASeededRandomRunShows) {
    const ParallelPid c{.Kp = 2, .Ki = 1.5, .Kd = 0.3, .filter = {FilterType::measurement_second_order, 0.05}};
    PlainLoop loop(1, 1, 0.3, c, 1e-3);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    double squares = 0;
    long count = 0;
    for (int k = 0; k < 100000; ++k) {
        const double n = normal(random);
        for (int i = 0; i < 20; ++i) {
            const double u = loop.step(n);
            if (k < 1000) continue;
            squares += u * u;
            ++count;
        }
    }
    const double gain = gain_of(noisy_plant(Fopdt{.K = 1, .T = 1, .L = 0.3}), c, 0.02);
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)) / gain, 1, 0.02);
}

TEST(NoiseGain, DependsOnRatiosOfTimesAlone) {
    const auto gain = [](double scale) {
        return gain_of(noisy_plant(Sopdt{.K = 1, .T1 = scale, .T2 = 0.2 * scale, .L = 0.1 * scale}),
                       {.Kp = 3, .Ki = 2 / scale, .Kd = 0.5 * scale, .filter = {FilterType::derivative, 0.02 * scale}},
                       0.01 * scale);
    };
    for (const double scale : {1e-6, 1e6}) EXPECT_NEAR(gain(scale) / gain(1), 1, 1e-6);
}

TEST(NoiseGain, IsInfiniteForADerivativeWithoutFilterAlone) {
    const auto plant = noisy_plant(Fopdt{.K = 1, .T = 1, .L = 1});
    const auto bare = Loop::make(plant, {.Kp = 0.5, .Ki = 0.5, .Kd = 0.1});
    ASSERT_TRUE(bare.has_value());
    EXPECT_FALSE(noise_gain(*bare, 0.1).has_value());
    const auto filtered =
        Loop::make(plant, {.Kp = 0.5, .Ki = 0.5, .Kd = 0.1, .filter = {FilterType::derivative, 0.01}});
    ASSERT_TRUE(filtered.has_value());
    EXPECT_TRUE(noise_gain(*filtered, 0.1).has_value());
}

TEST(DefaultNoiseSampleTime, FollowsFilterCrossoverOrPlant) {
    const auto plant = noisy_plant(Ipdt{.K = 2, .L = 0.1});
    EXPECT_DOUBLE_EQ(default_noise_sample_time(*Loop::make(plant, {.Kp = 1, .filter = {FilterType::derivative, 0.5}})),
                     0.05);
    // |L| = 2 Kp/omega crosses 1 at 1.
    EXPECT_NEAR(default_noise_sample_time(*Loop::make(plant, {.Kp = 0.5})), 0.02 * std::numbers::pi, 1e-9);
    const auto lag = noisy_plant(Fopdt{.K = 1, .T = 3, .L = 1});
    EXPECT_NEAR(default_noise_sample_time(*Loop::make(lag, {.Kp = 0.5})), 0.04, 1e-12);
}

}  // namespace
}  // namespace tunewright
