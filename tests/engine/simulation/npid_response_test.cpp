#include "engine/simulation/linear/linear_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

struct Case {
    const char* name;
    double T, L;  // of e^(-Ls)/(T s + 1)
    IdealPid pid;
    double delta_r;
    StepInputs in;
};

/// The reference: Heun's method with a small step on e^(-Ls)/(T s + 1), with the delayed u from a table.
ErrorIntegrals by_small_steps(const Case& c, double end, int steps_per_unit) {
    const double h = 1.0 / steps_per_unit;
    const int delay = static_cast<int>(std::lround(c.L * steps_per_unit)), n = static_cast<int>(end * steps_per_unit);
    const double Tf = c.pid.filter.Tf;
    std::vector<double> u(static_cast<std::size_t>(n + 1), 0.0);
    double y = 0, I = 0, z = 0;  // z' = (-y - z)/Tf
    const auto phi = [&](double e) { return e * std::exp(-e * e / (2 * c.delta_r * c.delta_r)); };
    const auto v = [&](int k) { return k < 0 ? 0 : u[static_cast<std::size_t>(k)] + c.in.d; };
    ErrorIntegrals sum;
    for (int k = 0; k < n; ++k) {
        const double rate = (v(k - delay) - y) / c.T;
        const double derivative = Tf > 0 ? (-y - z) / Tf : -rate;
        u[static_cast<std::size_t>(k)] = c.pid.Kp * (c.in.r - y + I / c.pid.Ti + c.pid.Td * derivative);
        // v is assumed linear within the step; its end value is known already since the delay is longer.
        const double predicted = y + h * rate;
        const double next = y + 0.5 * h * (rate + (v(k + 1 - delay) - predicted) / c.T);
        const double e0 = c.in.r - y, e1 = c.in.r - next;
        I += 0.5 * h * (phi(e0) + phi(e1));
        if (Tf > 0) z += h * (-0.5 * (y + next) - z) / (Tf + 0.5 * h);
        sum.IAE += 0.5 * h * (std::abs(e0) + std::abs(e1));
        sum.ISE += 0.5 * h * (e0 * e0 + e1 * e1);
        sum.ITAE += 0.5 * h * h * (k * std::abs(e0) + (k + 1) * std::abs(e1));
        y = next;
    }
    return sum;
}

TEST(NpidResponse, AgreesWithPlainSimulationInSmallSteps) {
    const Filter filter{FilterType::derivative, 0.05};
    const Case cases[] = {
        {"set point, pure derivative", 1, 0.5, {.Kp = 1.976, .Ti = 1.016, .Td = 0.1838}, 1, {1, 0}},
        {"set point, filtered", 1, 0.5, {.Kp = 1.976, .Ti = 1.016, .Td = 0.1838, .filter = filter}, 1, {1, 0}},
        {"PI", 1, 0.25, {.Kp = 1.5, .Ti = 0.8}, 1, {1, 0}},
        {"load, integral nearly stalled", 1, 0.5, {.Kp = 1.5, .Ti = 1, .Td = 0.15}, 0.2, {0, 1}},
        {"both steps", 2, 0.5, {.Kp = 3, .Ti = 1.5, .Td = 0.2}, 0.7, {1, -0.5}},
    };
    for (const Case& c : cases) {
        ResponseOptions options;
        options.horizon = 30;
        const auto response = simulate_npid(*LinearPlant::make(Fopdt{.K = 1, .T = c.T, .L = c.L}), to_parallel(c.pid),
                                            c.delta_r, c.in, options);
        EXPECT_DOUBLE_EQ(response.nodes.back().t, 30) << c.name;
        const auto e = error_integrals(response.nodes, c.in.r, std::nullopt);
        const auto oracle = by_small_steps(c, 30, 8000);
        EXPECT_NEAR(e.IAE / oracle.IAE, 1, 2e-4) << c.name;
        EXPECT_NEAR(e.ISE / oracle.ISE, 1, 2e-4) << c.name;
        EXPECT_NEAR(e.ITAE / oracle.ITAE, 1, 4e-4) << c.name;
    }
}

ErrorIntegrals integrals(const Plant& plant, const IdealPid& pid, double delta_r, const StepInputs& in,
                         double tolerance = 1e-6) {
    ResponseOptions options;
    options.tolerance = tolerance;
    const auto response = simulate_npid(*LinearPlant::make(plant), to_parallel(pid), delta_r, in, options);
    EXPECT_TRUE(response.settles);
    return error_integrals(response.nodes, in.r, response.error_integral_final);
}

const IdealPid kPid{.Kp = 1.976, .Ti = 1.016, .Td = 0.1838};
const IdealPid kFast{.Kp = 5, .Ti = 1, .Td = 0.1};

TEST(NpidResponse, IsTheLinearOneWhereDeltaIsLarge) {
    for (const Plant& plant : {Plant(Fopdt{.K = 1, .T = 1, .L = 0.5}), Plant(Sopdt{.K = 1, .T1 = 1, .T2 = 0.2, .L = 0}),
                               Plant(Ipdt{.K = 0.5, .L = 0.5})}) {
        const auto linear_plant = *LinearPlant::make(plant);
        for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, 1}}) {
            const auto linear = simulate_linear(linear_plant, to_parallel(kPid), in, {});
            const auto npid = simulate_npid(linear_plant, to_parallel(kPid), 1e8, in, {});
            EXPECT_NEAR(*npid.error_integral_final, *linear.error_integral_final,
                        1e-9 * (1 + std::abs(*linear.error_integral_final)));
            const auto a = error_integrals(linear.nodes, in.r, linear.error_integral_final),
                       b = error_integrals(npid.nodes, in.r, npid.error_integral_final);
            EXPECT_NEAR(b.IAE / a.IAE, 1, 1e-6);
            EXPECT_NEAR(b.ISE / a.ISE, 1, 1e-6);
        }
    }
}

TEST(NpidResponse, ScalesWithStepAndDeltaTogetherAndNotWithTheStepAlone) {
    const Fopdt plant{.K = 1, .T = 1, .L = 0.5};
    const double one = integrals(plant, kPid, 1, {1, 0}).IAE;
    EXPECT_NEAR(integrals(plant, kPid, 7, {-7, 0}).IAE / 7, one, 1e-7);
    EXPECT_GT(std::abs(integrals(plant, kPid, 1, {2, 0}).IAE / 2 / one - 1), 0.05);
    const double load = integrals(plant, kPid, 1, {0, 1}).IAE;
    EXPECT_GT(integrals(plant, kPid, 1, {0, 4}).IAE / 4 / load, 1.2) << "a larger load stalls the integral";
}

TEST(NpidResponse, ScalesWithGainAndTime) {
    const double one = integrals(Fopdt{.K = 1, .T = 1, .L = 0.5}, kPid, 1, {1, 0}).IAE;
    const IdealPid scaled{.Kp = kPid.Kp / -3, .Ti = 100 * kPid.Ti, .Td = 100 * kPid.Td};
    EXPECT_NEAR(integrals(Fopdt{.K = -3, .T = 100, .L = 50}, scaled, 1, {1, 0}).IAE / 100, one, 1e-7);
}

TEST(NpidResponse, HasItsLimitWithoutDeadTime) {
    const double none = integrals(Sopdt{.K = 1, .T1 = 1, .T2 = 0.2, .L = 0}, kFast, 1, {1, 0}).IAE;
    EXPECT_NEAR(integrals(Sopdt{.K = 1, .T1 = 1, .T2 = 0.2, .L = 1e-7}, kFast, 1, {1, 0}).IAE / none, 1, 5e-6);
    EXPECT_NEAR(integrals(Sopdt{.K = 1, .T1 = 1, .T2 = 0.2, .L = 1e-3}, kFast, 1, {1, 0}).IAE / none, 1, 1e-2);
}

TEST(NpidResponse, ToleranceDecidesTheAccuracy) {
    for (const double L : {0.0, 0.01, 0.5}) {
        const Sopdt plant{.K = 1, .T1 = 1, .T2 = 0.2, .L = L};
        const IdealPid pid{.Kp = 1.5, .Ti = 1, .Td = 0.1};
        const auto exact = integrals(plant, pid, 1, {1, 0}, 1e-9);
        EXPECT_NEAR(integrals(plant, pid, 1, {1, 0}, 1e-4).IAE / exact.IAE, 1, 1e-4) << L;
        EXPECT_NEAR(integrals(plant, pid, 1, {1, 0}, 1e-6).IAE / exact.IAE, 1, 1e-6) << L;
    }
}

TEST(NpidResponse, EchoesOfANeutralLoopAreJumps) {
    // Kp Td K/T = 0.69: u jumps by -0.69 times its last jump at every dead time.
    const Fopdt plant{.K = 1, .T = 1, .L = 0.1};
    const IdealPid pid{.Kp = 9.2, .Ti = 0.95, .Td = 0.075};
    const auto response = simulate_npid(*LinearPlant::make(plant), to_parallel(pid), 1, {1, 0}, {});
    std::vector<double> jumps;
    for (std::size_t i = 1; i < response.nodes.size(); ++i)
        if (response.nodes[i].t == response.nodes[i - 1].t)
            jumps.push_back(response.nodes[i].u - response.nodes[i - 1].u);
    ASSERT_GT(jumps.size(), 5u);
    EXPECT_NEAR(jumps[0], -0.69 * 9.2, 1e-9);
    EXPECT_NEAR(jumps[1], 0.69 * 0.69 * 9.2, 1e-9);
}

TEST(NpidResponse, AStalledIntegralEndsTheRunWithoutSettling) {
    ResponseOptions options;
    options.max_steps = 5000;
    const auto response =
        simulate_npid(*LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 0.5}), to_parallel(kPid), 0.02, {0, 1}, options);
    EXPECT_FALSE(response.settles);
    for (const auto& node : response.nodes) ASSERT_TRUE(std::isfinite(node.y) && std::isfinite(node.u));
    // Held by P action alone.
    EXPECT_NEAR(response.nodes.back().y, 1 / (1 + kPid.Kp), 0.05);
}

TEST(NpidResponse, GrowthEndsTheRunWithFiniteValues) {
    const IdealPid unstable{.Kp = 8, .Ti = 1, .Td = 0};
    for (const double L : {0.5, 3.0}) {
        const auto response =
            simulate_npid(*LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = L}), to_parallel(unstable), 1, {1, 0}, {});
        EXPECT_FALSE(response.settles);
        for (const auto& node : response.nodes) ASSERT_TRUE(std::isfinite(node.y) && std::isfinite(node.u));
    }
}

TEST(ErrorScaling, GainAndDescribingFunction) {
    const ErrorScaling scaling{2};
    EXPECT_NEAR(scaling.excess(2) + 2, 2 * std::exp(-0.5), 1e-15);
    EXPECT_NEAR(scaling.excess_slope(2) + 1, 0, 1e-15) << "phi is largest at delta_r";
    EXPECT_NEAR(scaling.excess(1e-9), 0, 1e-25);
    // (1/(pi A)) int phi(A sin) sin over a period, by 4000 points.
    for (const double A : {0.1, 1.0, 3.0, 10.0, 60.0}) {
        double sum = 0;
        for (int i = 0; i < 4000; ++i) {
            const double s = std::sin(2 * std::numbers::pi * i / 4000);
            sum += (scaling.excess(A * s) + A * s) * s / (2000 * A);
        }
        EXPECT_NEAR(scaling.gain_of_amplitude(A) / sum, 1, 1e-6) << A;
        EXPECT_NEAR(scaling.amplitude_of_gain(sum) / A, 1, 1e-5) << A;
    }
}

}  // namespace
}  // namespace tunewright
