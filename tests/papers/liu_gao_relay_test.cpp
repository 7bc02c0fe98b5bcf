// Liu and Gao (2008), Table 1: the limit cycles of three relay tests. The printed values have the sampling errors of
// the authors' simulation (0.01 s): the exact ones differ by up to 0.1 % and were computed by an independent
// event-accurate simulation with machine-precision integrals. The sampled relay with left-rectangle sums gives the
// printed values.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "engine/simulation/relay/relay.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

const Plant kFirst = Fopdt{.K = 1, .T = 10, .L = 2};
const Plant kSecond = TransferFunction{.num = {-1, 1}, .den = {1, 5, 10, 10, 5, 1}, .L = 1};
const Plant kThird = Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1};

RelaySettings unbiased() {
    RelaySettings settings;
    settings.hysteresis = 0.2;
    settings.shift = 0.1;
    return settings;
}

RelaySettings biased() {
    RelaySettings settings = unbiased();
    settings.u_plus = 1.3;
    settings.u_minus = -0.7;
    return settings;
}

struct Row {
    const char* name;
    Plant plant;
    RelaySettings settings;
    double Pu, Au, phi_u, A_alpha, t_plus, t_minus, y_max, y_min;
};

std::vector<Row> rows() {
    return {{"example 1, unbiased", kFirst, unbiased(), 14.39098, 0.2232584, -2.218852, 0.1704858, 7.19549, 7.19549,
             0.3450154, -0.3450154},
            {"example 1, biased", kFirst, biased(), 15.56731, 0.2404901, -2.135154, 0.1817588, 5.688229, 9.879083,
             0.3993962, -0.2906346},
            {"example 2, biased", kSecond, biased(), 14.3658, 0.7046321, -2.911185, 0.3895188, 6.293695, 8.072102,
             1.150174, -0.6914078},
            {"example 3, unbiased", kThird, unbiased(), 26.05589, 0.1828708, -2.056866, 0.1231808, 13.02794, 13.02794,
             0.2549752, -0.2549752}};
}

TEST(LiuGaoRelay, TableOneRecomputedExactly) {
    for (const Row& row : rows()) {
        const auto experiment = simulate_relay(row.plant, row.settings, {});
        ASSERT_TRUE(experiment) << row.name << ": " << experiment.error().message;
        const LimitCycle& cycle = experiment->limit_cycle;
        EXPECT_NEAR(cycle.Pu, row.Pu, 1e-6 * row.Pu) << row.name;
        EXPECT_NEAR(cycle.Au, row.Au, 1e-6 * row.Au) << row.name;
        EXPECT_NEAR(cycle.phi_u, row.phi_u, 1e-6) << row.name;
        EXPECT_NEAR(cycle.shift->A, row.A_alpha, 1e-6 * row.A_alpha) << row.name;
        EXPECT_NEAR(*cycle.t_plus, row.t_plus, 1e-6 * row.t_plus) << row.name;
        EXPECT_NEAR(*cycle.t_minus, row.t_minus, 1e-6 * row.t_minus) << row.name;
        EXPECT_NEAR(*cycle.y_max, row.y_max, 1e-6) << row.name;
        EXPECT_NEAR(*cycle.y_min, row.y_min, 1e-6) << row.name;
        EXPECT_FALSE(experiment->reversed) << row.name;
    }
}

// The row of the i-th rise of u to u_plus after the start, counted from the end of the record (0: its last row).
std::size_t rise_from_end(const RelayRecord& record, int count, double u_plus) {
    std::size_t at = record.t.size() - 1;
    while (count > 0) {
        --at;
        if (at > 0 && record.u[at] == u_plus && record.u[at - 1] != u_plus) --count;
    }
    return at;
}

// Eq. 4 over the last `cycles` cycles: trapezoids of y and exact integrals of u, or left rectangles of both.
Complex fourier_ratio(const RelayRecord& record, int cycles, double u_plus, bool rectangles) {
    const std::size_t first = rise_from_end(record, cycles, u_plus), last = record.t.size() - 1;
    const double omega = 2 * kPi * cycles / (record.t[last] - record.t[first]);
    const auto turn = [&](double t) { return std::exp(Complex(0, -omega * t)); };
    Complex Y = 0, U = 0;
    for (std::size_t i = first; i < last; ++i) {
        const double t = record.t[i], next = record.t[i + 1], h = next - t;
        if (rectangles) {
            Y += h * record.y[i] * turn(t);
            U += h * record.u[i] * turn(t);
        } else {
            Y += h / 2 * (record.y[i] * turn(t) + record.y[i + 1] * turn(next));
            U += record.u[i] * (turn(t) - turn(next)) / Complex(0, omega);
        }
    }
    return Y / U;
}

TEST(LiuGaoRelay, EquationFourOnTheRecordGivesTheSteadyCycle) {
    for (Row row : rows()) {
        row.settings.record_interval = 0.01;
        const auto experiment = simulate_relay(row.plant, row.settings, {});
        ASSERT_TRUE(experiment) << row.name;
        const Complex G = fourier_ratio(experiment->record, 3, row.settings.u_plus, false);
        EXPECT_NEAR(std::abs(G), row.Au, 1e-5 * row.Au) << row.name;
        EXPECT_NEAR(std::arg(G), row.phi_u, 1e-5) << row.name;
    }
}

TEST(LiuGaoRelay, LeftRectanglesOnASampledRelayGiveThePrintedRows) {
    struct Printed {
        Plant plant;
        RelaySettings settings;
        double Pu, Au, phi_u;
        double tolerance;  ///< larger for example 1's biased relay, which never repeats exactly
    };
    for (Printed row : {Printed{kFirst, unbiased(), 14.40, 0.2233915, -2.22035, 3e-5},
                        Printed{kFirst, biased(), 15.581, 0.2406925, -2.136288, 2e-4},
                        Printed{kSecond, biased(), 14.38, 0.7050786, -2.910762, 3e-5},
                        Printed{kThird, unbiased(), 26.08, 0.183065, -2.057301, 3e-5}}) {
        row.settings.relay_sample_time = 0.01;
        row.settings.cycles = 20;
        const auto experiment = simulate_relay(row.plant, row.settings, {});
        ASSERT_TRUE(experiment) << experiment.error().message;
        EXPECT_NEAR(experiment->limit_cycle.Pu, row.Pu, 0.0011);
        const Complex G = fourier_ratio(experiment->record, 10, row.settings.u_plus, true);
        EXPECT_NEAR(std::abs(G), row.Au, row.tolerance * row.Au);
        EXPECT_NEAR(std::arg(G), row.phi_u, row.tolerance);
    }
}

// Example 1 with noise N(0, 0.00045) on the relay's input. Printed: 14.03, 0.2182, -2.2506, one run. The means and
// deviations here come from an independent simulation of many runs.
TEST(LiuGaoRelay, NoiseMovesTheCycleAsItDoesInTheReference) {
    constexpr int kSeeds = 30, kPeriods = 10;
    double Pu = 0, Au = 0, phi = 0, K = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        RelaySettings settings = biased();
        settings.noise_std = std::sqrt(0.00045);
        settings.relay_sample_time = 0.01;
        settings.cycles = kPeriods + 3;
        settings.seed = seed;
        const auto experiment = simulate_relay(kFirst, settings, {});
        ASSERT_TRUE(experiment) << experiment.error().message;
        const RelayRecord& record = experiment->record;
        const std::size_t first = rise_from_end(record, kPeriods, settings.u_plus);
        Pu += (record.t.back() - record.t[first]) / kPeriods / kSeeds;
        const Complex G = fourier_ratio(record, kPeriods, settings.u_plus, false);
        Au += std::abs(G) / kSeeds;
        phi += std::arg(G) / kSeeds;
        double y = 0, u = 0;
        for (std::size_t i = first; i + 1 < record.t.size(); ++i) {
            y += record.y[i];
            u += record.u[i];
        }
        K += y / u / kSeeds;
    }
    const double wide = 4 / std::sqrt(double{kSeeds});
    EXPECT_NEAR(Pu, 14.14843, wide * 0.07251334);
    EXPECT_NEAR(Au, 0.2197189, wide * 0.001074789);
    EXPECT_NEAR(phi, -2.237351, wide * 0.005949353);
    EXPECT_NEAR(K, 1, wide * 0.02739656);
}

}  // namespace
}  // namespace tunewright
