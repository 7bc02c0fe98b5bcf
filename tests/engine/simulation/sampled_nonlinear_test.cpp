#include "engine/simulation/sampled/sampled_response.h"

#include <gtest/gtest.h>

#include "engine/plant/nonlinear/linearisation.h"
#include "engine/simulation/linear/indices.h"
#include "tests/engine/loop/sampled_cases.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

using namespace test;

/// The largest difference of y and of u at even times that lie between the samples, relative to the largest values.
double largest_difference(const StepResponse& a, const StepResponse& b, double horizon, int points) {
    const auto of_a = sampled(a.nodes, horizon, points), of_b = sampled(b.nodes, horizon, points);
    double dy = 0, du = 0, y = 0, u = 0;
    for (std::size_t i = 1; i < of_a.size(); i += 2) {
        dy = std::max(dy, std::abs(of_a[i].first - of_b[i].first));
        du = std::max(du, std::abs(of_a[i].second - of_b[i].second));
        y = std::max(y, std::abs(of_b[i].first));
        u = std::max(u, std::abs(of_b[i].second));
    }
    return std::max(dy / y, du / u);
}

TEST(SampledNonlinear, OfALinearPlantInEquationsItIsTheLinearOne) {
    Random random(3);
    int compared = 0;
    for (const KnownPlant& known : known_plants()) {
        ++compared;
        const double Ts = compared % 2 == 0 ? 0.1 : 0.35;
        const auto c = random_case(known, random, Ts, compared % 4 * 130, compared % 3 * 170, compared % 3,
                                   compared % 6, compared % 4);
        if (!c) continue;
        SCOPED_TRACE(c->name);
        const LinearPlant plant = *LinearPlant::make(c->plant);
        const auto equations = as_equations(plant);
        if (!equations) continue;  // a direct term
        const double horizon = 60 * Ts;
        const StepInputs in = compared % 2 == 0 ? StepInputs{1, 0.3} : StepInputs{0, 1};
        for (const bool limited : {false, true}) {
            ProgramLimits limits;
            if (limited) limits = {.output = ActuatorLimits{-0.4, 0.5}, .y_resolution = 0.0137};
            SampledOptions fine;
            fine.tolerance = 1e-9;
            fine.horizon = horizon;
            const StepResponse linear = simulate_sampled(plant, c->law, limits, in, fine);
            const StepResponse nonlinear = simulate_sampled(*equations, c->law, limits, in, {.horizon = horizon});
            EXPECT_LT(largest_difference(nonlinear, linear, horizon, 2 * 60 * 12 + 1), 1e-6);
            EXPECT_NEAR(nonlinear.nodes.back().t, horizon, 1e-9);
        }
        const StepResponse linear = simulate_sampled(plant, c->law, {}, in, {});
        const StepResponse nonlinear = simulate_sampled(*equations, c->law, {}, in, {});
        EXPECT_TRUE(nonlinear.settles);
        const double IAE = integral_of_absolute_error(linear.nodes, in.r, linear.error_integral_final);
        EXPECT_NEAR(integral_of_absolute_error(nonlinear.nodes, in.r, nonlinear.error_integral_final), IAE, 2e-6 * IAE);
        EXPECT_NEAR(total_variation(nonlinear.nodes), total_variation(linear.nodes),
                    2e-6 * total_variation(linear.nodes));
    }
    EXPECT_GT(compared, 30);
}

/// The spherical tank's level with the sampled law, by classical Runge-Kutta steps of Ts/parts; deviations.
struct OwnTank {
    double h = 0.3, q = 0.4 * std::sqrt(0.3), dead_time = 0;

    static double rate(double level, double inflow) {
        return (inflow - 0.4 * std::sqrt(level)) / (std::numbers::pi * level * (1 - level));
    }
    /// y in the middle of every part.
    std::vector<double> run(const SampledPid& law, const ProgramLimits& limits, double r, double d, int samples,
                            int parts) const {
        const long lag_load = std::lround(dead_time / law.Ts * parts),
                   lag = lag_load + std::lround(law.computation_delay / law.Ts * parts);
        OwnLaw program(law);
        std::vector<double> u, y;
        double level = h;
        const auto move = [&](double inflow, double dt) {
            const double k1 = rate(level, inflow), k2 = rate(level + dt / 2 * k1, inflow),
                         k3 = rate(level + dt / 2 * k2, inflow), k4 = rate(level + dt * k3, inflow);
            level += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        };
        for (int k = 0; k < samples; ++k) {
            const double wanted = program.step(r, level - h);
            u.push_back(limits.output ? std::clamp(wanted, limits.output->min, limits.output->max) : wanted);
            for (int j = 0; j < parts; ++j) {
                const long g = long(k) * parts + j;
                const double inflow = q + (g >= lag ? u[std::size_t((g - lag) / parts)] : 0) + (g >= lag_load ? d : 0);
                move(inflow, law.Ts / parts / 2);
                y.push_back(level - h);
                move(inflow, law.Ts / parts / 2);
            }
        }
        return y;
    }
};

TEST(SampledNonlinear, OfATankItIsThatOfRungeKutta) {
    for (const double L : {0.0, 0.35, 1.2})
        for (const double delay : {0.0, 0.12, 0.68})
            for (const bool proportional : {false, true}) {
                OwnTank own;
                own.dead_time = L;
                NonlinearPlant description = spherical_tank(own.h, own.q);
                description.L = L;
                SampledPid law{.gains = {.Kp = 0.25,
                                         .Ki = proportional ? 0 : 0.06,
                                         .Kd = 0.05,
                                         .b = 0.7,
                                         .filter = {FilterType::derivative, 0.3}},
                               .Ts = 0.4};
                law.computation_delay = delay;
                ProgramLimits limits;
                if (proportional) limits.output = ActuatorLimits{-0.02, 0.03};
                constexpr int kSamples = 60, kParts = 40;
                for (const StepInputs in : {StepInputs{0.3, 0}, StepInputs{-0.15, 0.013}}) {
                    const StepResponse response =
                        simulate_sampled(made_system(description), law, limits, in, {.horizon = 0.4 * kSamples});
                    const std::vector<double> expected = own.run(law, limits, in.r, in.d, kSamples, kParts);
                    const auto values = sampled(response.nodes, 0.4 * kSamples, 2 * kSamples * kParts + 1);
                    double worst = 0, largest = 0;
                    for (std::size_t i = 0; i < expected.size(); ++i) {
                        worst = std::max(worst, std::abs(expected[i] - values[2 * i + 1].first));
                        largest = std::max(largest, std::abs(expected[i]));
                    }
                    EXPECT_LT(worst, 3e-6 * largest) << L << ' ' << delay << ' ' << in.r;
                    EXPECT_EQ(response.nodes.front().t, 0);
                    for (std::size_t i = 1; i < response.nodes.size(); ++i)
                        ASSERT_GE(response.nodes[i].t, response.nodes[i - 1].t);
                }
            }
}

// h = q + u = c sqrt(h) at rest: for any sample time, a proportional law settles at u = Kp (r - y).
TEST(SampledNonlinear, WithoutIntegralActionRestsWhereTheLawDoes) {
    const OwnTank own;
    const NonlinearSystem tank = made_system(spherical_tank(own.h, own.q));
    for (const double Ts : {1.0, 0.1, 0.01, 0.001}) {
        const SampledPid law{.gains = {.Kp = 0.3}, .Ts = Ts};
        const StepResponse response = simulate_sampled(tank, law, {}, {0.2, 0}, {});
        ASSERT_TRUE(response.settles);
        EXPECT_FALSE(response.error_integral_final);
        const double y = response.y_final;
        EXPECT_NEAR(own.q + 0.3 * (0.2 - y), 0.4 * std::sqrt(own.h + y), 1e-7) << Ts;
    }
}

TEST(SampledNonlinear, ComesToRestAtALimit) {
    const OwnTank own;
    const NonlinearSystem tank = made_system(spherical_tank(own.h, own.q));
    const SampledPid law{.gains = {.Kp = 0.3, .Ki = 0.1}, .Ts = 0.2};
    const StepResponse response = simulate_sampled(tank, law, {.output = ActuatorLimits{-0.05, 0.05}}, {0.5, 0}, {});
    EXPECT_TRUE(response.settles);
    EXPECT_FALSE(response.error_integral_final);
    EXPECT_LT(response.nodes.back().t, 1000);
    EXPECT_NEAR(response.y_final, std::pow((own.q + 0.05) / 0.4, 2) - own.h, 1e-6);
    EXPECT_EQ(response.u_final, 0.05);
}

// More flows out than in: the level reaches 0, where the equations end.
TEST(SampledNonlinear, EndsWhereTheStatesLeaveTheDomain) {
    const OwnTank own;
    const NonlinearSystem tank = made_system(spherical_tank(own.h, own.q));
    const StepResponse response = simulate_sampled(tank, {.gains = {.Kp = 0.1}, .Ts = 0.2}, {}, {0, -0.3}, {});
    EXPECT_FALSE(response.settles);
    EXPECT_LT(response.nodes.back().t, 100);
    for (const ResponseNode& node : response.nodes) ASSERT_TRUE(std::isfinite(node.y + node.u + node.error_integral));
}

}  // namespace
}  // namespace tunewright
