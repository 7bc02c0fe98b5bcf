// The loop with actuator limits compared with a simple simulation in tiny steps, with the loop without limits, and with
// closed-form cases.
#include "engine/simulation/limited/limited_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/simulation/linear/indices.h"
#include "tests/engine/simulation/plain_limited_loop.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LinearPlant made(const Plant& plant) {
    auto result = LinearPlant::make(plant);
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return *result;
}

struct LimitedCase {
    const char* name;
    Plant plant;
    ParallelPid gains;
    StepInputs in;
    ActuatorLimits limits;
    double horizon, dt;
};

const FilterType kSecond = FilterType::measurement_second_order, kDerivative = FilterType::derivative;

std::vector<LimitedCase> limited_cases() {
    return {
        {"PI on a lag with dead time",
         Fopdt{.K = 1, .T = 1, .L = 1},
         {.Kp = 0.9, .Ki = 0.8},
         {1, 0},
         {-0.1, 1.05},
         20,
         1e-3},
        {"PI on a lag without dead time",
         Fopdt{.K = 2, .T = 3, .L = 0},
         {.Kp = 4, .Ki = 5},
         {1, 0},
         {-0.5, 0.8},
         20,
         1e-3},
        {"PID, derivative filter, kick",
         Sopdt{.K = 1, .T1 = 1, .T2 = 0.5, .L = 0.2},
         {.Kp = 4, .Ki = 3, .Kd = 1, .b = 1, .c = 1, .filter = {kDerivative, 0.05}},
         {1, 0},
         {-1.5, 2},
         15,
         1e-3},
        {"PID, second-order filter",
         Sopdt{.K = 1, .T1 = 1, .T2 = 0.5, .L = 0.2},
         {.Kp = 4, .Ki = 3, .Kd = 1, .b = 1, .filter = {kSecond, 0.05}},
         {1, 0},
         {-0.2, 1.3},
         15,
         1e-3},
        {"load that nearly takes all authority",
         Fopdt{.K = 1, .T = 4, .L = 0.5},
         {.Kp = 4, .Ki = 3},
         {0, 1},
         {-1.05, 0.3},
         40,
         1e-3},
        {"direct action", Fopdt{.K = -1, .T = 2, .L = 0.5}, {.Kp = -2.2, .Ki = -1.2}, {1, 0}, {-1.2, 0.1}, 20, 1e-3},
        {"integrating plant", Ipdt{.K = 1, .L = 0.5}, {.Kp = 0.8, .Ki = 0.2}, {1, 0}, {-0.15, 0.3}, 40, 1e-3},
        {"unstable plant that the limits can hold",
         Fopdt{.K = -1, .T = -1, .L = 0.1},
         {.Kp = 3, .Ki = 0.6},
         {0, 0.2},
         {-0.295, 0.5},
         20,
         1e-3},
        {"inverse response, pure integral action",
         TransferFunction{.num = {-0.5, 1}, .den = {1, 2, 1}, .L = 0.3},
         {.Ki = 0.35},
         {1, 0},
         {-0.1, 1.02},
         40,
         1e-3},
        {"P alone", Fopdt{.K = 1, .T = 1, .L = 0.4}, {.Kp = 2}, {1, 0}, {-0.5, 0.8}, 20, 1e-3},
        {"direct term and dead time: the command jumps at every echo",
         TransferFunction{.num = {0.3, 1}, .den = {1, 1}, .L = 0.5},
         {.Kp = 1, .Ki = 0.8},
         {1, 0},
         {-0.2, 1.02},
         25,
         2.5e-4},
        {"limits that are never left again",
         Fopdt{.K = 1, .T = 1, .L = 0.3},
         {.Kp = 1, .Ki = 1},
         {1, 0},
         {-0.5, 0.6},
         30,
         1e-3},
    };
}

TEST(LimitedResponse, AgreesWithAPlainSimulationInTinySteps) {
    for (const LimitedCase& c : limited_cases()) {
        SCOPED_TRACE(c.name);
        const auto plant = made(c.plant);
        ResponseOptions options;
        options.horizon = c.horizon;
        const auto response = simulate_limited(plant, c.gains, c.in, c.limits, options);
        const double Tt = tracking_time(plant, c.gains);
        const Figures plain = PlainSimulation(plant, c.gains, c.in, c.limits, Tt).run(c.horizon, c.dt);
        EXPECT_TRUE(response.settles);
        EXPECT_DOUBLE_EQ(response.nodes.back().t, c.horizon);
        EXPECT_NEAR(error_integrals(response.nodes, c.in.r, std::nullopt).IAE / plain.IAE, 1, 5e-4);
        for (int i = 0; i < 10; ++i)
            EXPECT_NEAR(sampled(response.nodes, c.horizon * (i + 1) / 10, 2)[1].first,
                        plain.y[static_cast<std::size_t>(i)], 1e-3)
                << i;
        EXPECT_NEAR(extremes_of_y(response.nodes).max - c.in.r, plain.overshoot, 1e-3);
        // At least one limit was reached, none exceeded.
        const auto [low, high] = std::minmax_element(response.nodes.begin(), response.nodes.end(),
                                                     [](const auto& a, const auto& b) { return a.u < b.u; });
        EXPECT_LE(high->u, c.limits.max * (1 + 1e-9));
        EXPECT_GE(low->u, c.limits.min * (1 + 1e-9));
        EXPECT_TRUE(high->u > c.limits.max * (1 - 1e-9) || low->u < c.limits.min * (1 - 1e-9));
    }
}

TEST(LimitedResponse, EqualsTheLinearResponseWhereTheLimitsAreNotReached) {
    for (const double L : {0.0, 1e-7, 1e-3, 0.1, 1.0, 30.0})
        for (const auto type : {FilterType::none, FilterType::derivative, FilterType::measurement_first_order,
                                FilterType::measurement_second_order})
            for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, -1}}) {
                SCOPED_TRACE(testing::Message() << L << " " << static_cast<int>(type) << " " << in.r);
                const auto plant = made(Sopdt{.K = 1, .T1 = 1, .T2 = 0.6, .L = L});
                const double Tf = type == FilterType::none ? 0 : 0.05;
                ParallelPid gains{.Kp = 1 / (1 + L), .Ki = 0.6 / (1 + L), .Kd = 0.3 / (1 + L)};
                gains.filter = {type, Tf};
                if (type == FilterType::derivative) gains.c = 1;
                ResponseOptions options;
                options.tolerance = 1e-7;
                const auto linear = simulate_linear(plant, gains, in, options);
                for (const double far : {100.0, kInfinity}) {
                    const auto limited = simulate_limited(plant, gains, in, {-far, far}, options);
                    EXPECT_TRUE(limited.settles);
                    ASSERT_TRUE(limited.error_integral_final && linear.error_integral_final);
                    EXPECT_NEAR(*limited.error_integral_final, *linear.error_integral_final,
                                1e-6 * std::abs(*linear.error_integral_final));
                    const double IAE = error_integrals(linear.nodes, in.r, linear.error_integral_final).IAE;
                    EXPECT_NEAR(error_integrals(limited.nodes, in.r, limited.error_integral_final).IAE, IAE,
                                1e-6 * IAE);
                    EXPECT_NEAR(total_variation(limited.nodes) / total_variation(linear.nodes), 1, 1e-5);
                    EXPECT_NEAR(limited.u_final, linear.u_final, 1e-12);
                    for (const auto& node : linear.nodes) {
                        if (node.t > limited.nodes.back().t) break;
                        EXPECT_NEAR(sampled(limited.nodes, node.t, 2)[1].first, node.y, 1e-6) << node.t;
                    }
                }
            }
}

TEST(LimitedResponse, MirrorsWithLimitsAndStepsMirrored) {
    for (const LimitedCase& c : limited_cases()) {
        SCOPED_TRACE(c.name);
        const auto plant = made(c.plant);
        const auto one = simulate_limited(plant, c.gains, c.in, c.limits, {});
        const auto other = simulate_limited(plant, c.gains, {-c.in.r, -c.in.d}, {-c.limits.max, -c.limits.min}, {});
        ASSERT_EQ(one.nodes.size(), other.nodes.size());
        for (std::size_t i = 0; i < one.nodes.size(); ++i) {
            EXPECT_DOUBLE_EQ(one.nodes[i].y, -other.nodes[i].y);
            EXPECT_DOUBLE_EQ(one.nodes[i].u, -other.nodes[i].u);
        }
        EXPECT_DOUBLE_EQ(one.u_final, -other.u_final);
    }
}

TEST(LimitedResponse, ScalesWithTimeFromMillisecondsToYears) {
    const auto figures = [](double scale) {
        const auto plant = made(Fopdt{.K = 1, .T = scale, .L = 0.4 * scale});
        const auto response = simulate_limited(plant, {.Kp = 2, .Ki = 2 / scale}, {1, 0}, {-0.1, 1.2}, {});
        return error_integrals(response.nodes, 1, response.error_integral_final).IAE / scale;
    };
    const double reference = figures(1);
    for (const double scale : {1e-4, 3e7}) EXPECT_NEAR(figures(scale) / reference, 1, 1e-6);
}

TEST(LimitedResponse, SmallDeadTimesTakeFewStepsAndApproachNone) {
    const ParallelPid gains{.Kp = 6, .Ki = 6};
    const auto IAE = [&](double L) {
        const auto plant = made(Sopdt{.K = 1, .T1 = 1, .T2 = 0.1, .L = L});
        const auto response = simulate_limited(plant, gains, {1, 0}, {-1, 1.5}, {});
        EXPECT_TRUE(response.settles) << L;
        EXPECT_LT(response.nodes.size(), 4000u) << L;
        return error_integrals(response.nodes, 1, response.error_integral_final).IAE;
    };
    const double without = IAE(0);
    for (const double L : {1e-9, 1e-7, 1e-5, 1e-3}) EXPECT_NEAR(IAE(L), without, 2 * L + 2e-6 * without) << L;
}

TEST(LimitedResponse, SaturatedIntegratorRampsExactly) {
    // P control of 1/s with Kp = 2 and |u| <= 0.5: u = 0.5 until y = 0.75 at t = 1.5, then e = 0.25 e^(-2 (t - 1.5)).
    const auto plant = made(Ipdt{.K = 1, .L = 0});
    const auto response = simulate_limited(plant, {.Kp = 2}, {1, 0}, {-0.5, 0.5}, {});
    EXPECT_TRUE(response.settles);
    EXPECT_NEAR(sampled(response.nodes, 1.5, 2)[1].first, 0.75, 1e-9);
    EXPECT_NEAR(1 - sampled(response.nodes, 2, 2)[1].first, 0.25 * std::exp(-1), 1e-7);
    EXPECT_NEAR(error_integrals(response.nodes, 1, std::nullopt).IAE, 1.5 * (1 + 0.25) / 2 + 0.125, 2e-6);
}

TEST(LimitedResponse, AntiWindupCutsTheOvershootOfWindup) {
    // The same law without tracking overshoots by far more, as the simple simulation with Tt = infinity shows.
    const auto plant = made(Ipdt{.K = 1, .L = 0.2});
    const ParallelPid gains{.Kp = 1.5, .Ki = 0.6};
    const StepInputs in{5, 0};
    const ActuatorLimits limits{-0.5, 0.5};
    const auto response = simulate_limited(plant, gains, in, limits, {});
    const double overshoot = extremes_of_y(response.nodes).max - 5;
    const double windup = PlainSimulation(plant, gains, in, limits, kInfinity).run(60, 2e-3).overshoot;
    EXPECT_GT(windup, 2);
    EXPECT_LT(overshoot, 0.25 * windup);
    EXPECT_TRUE(response.settles);
}

TEST(LimitedResponse, AlgebraicLoopWithLimitsIsSolvedAtEveryInstant) {
    // y = 0.5 (u + d) + lag, no dead time: command = Kp (r - y) + ..., u = its limited value, at every node.
    const auto plant = made(TransferFunction{.num = {0.5, 1}, .den = {1, 1}, .L = 0});
    const ParallelPid gains{.Kp = 3};
    const auto response = simulate_limited(plant, gains, {1, 0}, {-0.2, 0.75}, {});
    EXPECT_TRUE(response.settles);
    for (const auto& node : response.nodes) {
        const double command = gains.Kp * (1 - node.y);
        EXPECT_NEAR(node.u, std::clamp(command, -0.2, 0.75), 1e-9) << node.t;
    }
    // u(0): (1 + 0.5 Kp) u = Kp gives 1.2, beyond the limit: 0.75 and y = 0.375. At rest (1 + Kp) u = Kp: 0.75 as well.
    EXPECT_DOUBLE_EQ(response.nodes[0].u, 0.75);
    EXPECT_DOUBLE_EQ(response.nodes[0].y, 0.375);
    EXPECT_NEAR(response.y_final, 0.75, 1e-12);
}

TEST(LimitedResponse, RestsAtTheLimitWhereTheTargetIsOutOfReach) {
    const auto plant = made(Fopdt{.K = 2, .T = 1, .L = 0.5});
    const auto response = simulate_limited(plant, {.Kp = 0.5, .Ki = 0.4}, {1, 0}, {-1, 0.4}, {});
    EXPECT_TRUE(response.settles);
    EXPECT_DOUBLE_EQ(response.u_final, 0.4);
    EXPECT_DOUBLE_EQ(response.y_final, 0.8);
    EXPECT_FALSE(response.error_integral_final);
    EXPECT_NEAR(response.nodes.back().y, 0.8, 1e-6);
}

TEST(LimitedResponse, ErrorIntegralToInfinityIsThatOfALongRun) {
    const auto plant = made(Fopdt{.K = 1, .T = 5, .L = 1});
    const ParallelPid gains{.Kp = 2, .Ki = 0.35, .Kd = 0.7, .b = 1, .filter = {kSecond, 0.1}};
    const auto response = simulate_limited(plant, gains, {1, 0.1}, {-0.5, 1.1}, {});
    ResponseOptions longer;
    longer.horizon = 500;
    const auto long_run = simulate_limited(plant, gains, {1, 0.1}, {-0.5, 1.1}, longer);
    ASSERT_TRUE(response.error_integral_final);
    EXPECT_NEAR(*response.error_integral_final, long_run.nodes.back().error_integral, 2e-6 * 5);
}

TEST(LimitedResponse, EscapesEndFinitelyAndSaySo) {
    struct {
        Plant plant;
        ParallelPid gains;
        StepInputs in;
        ActuatorLimits limits;
    } escapes[] = {
        {Fopdt{.K = -1, .T = -1, .L = 0.1}, {.Kp = 3, .Ki = 0.6}, {0, 1}, {-0.5, 0.5}},  // diverges
        {Fopdt{.K = -1, .T = -1, .L = 0}, {.Kp = 3, .Ki = 0.6}, {0, 1}, {-0.5, 0.5}},
        {Ipdt{.K = 1, .L = 0.5}, {.Kp = 0.8, .Ki = 0.2}, {0, 1}, {-0.5, 0.5}},  // an endless ramp
        {Ipdt{.K = 1, .L = 1e-6}, {.Kp = 0.8, .Ki = 0.2}, {0, 1}, {-0.5, 0.5}},
        {Fopdt{.K = 1, .T = 1, .L = 1}, {.Kp = 10, .Ki = 10}, {1, 0}, {-1, 2}},  // a limit cycle
        {Fopdt{.K = 1, .T = 0, .L = 1}, {.Kp = 2, .Ki = 1}, {1, 0}, {-3, 2}},    // a neutral loop, q = 2
        {TransferFunction{.num = {1, 1}, .den = {0.5, 1}, .L = 0}, {.Kp = -1.5, .Ki = 1}, {1, 0}, {-1, 2}},  // N > 1
        {Fopdt{.K = 1, .T = 1, .L = 1}, {.Kp = 10, .Ki = 10}, {1, 0}, {-kInfinity, kInfinity}},
    };
    for (const auto& e : escapes) {
        SCOPED_TRACE(&e - escapes);
        const auto response = simulate_limited(made(e.plant), e.gains, e.in, e.limits, {});
        EXPECT_FALSE(response.settles);
        EXPECT_LE(response.nodes.size(), 60010u);
        for (const auto& node : response.nodes) {
            ASSERT_TRUE(std::isfinite(node.t) && std::isfinite(node.y) && std::isfinite(node.y_slope) &&
                        std::isfinite(node.u) && std::isfinite(node.u_slope) && std::isfinite(node.error_integral));
            EXPECT_TRUE(node.u <= e.limits.max + 1e-9 && node.u >= e.limits.min - 1e-9);
        }
        EXPECT_DOUBLE_EQ(response.y_final, response.nodes.back().y);
    }
}

TEST(LimitedResponse, ATighterToleranceChangesTheIntegralsByLessThanPromised) {
    for (const LimitedCase& c : limited_cases()) {
        SCOPED_TRACE(c.name);
        const auto plant = made(c.plant);
        ResponseOptions options, fine;
        options.horizon = fine.horizon = c.horizon;
        fine.tolerance = 1e-8;
        const auto usual = simulate_limited(plant, c.gains, c.in, c.limits, options);
        const auto tight = simulate_limited(plant, c.gains, c.in, c.limits, fine);
        EXPECT_LT(usual.nodes.size(), 3000u);
        const double IAE = error_integrals(tight.nodes, c.in.r, std::nullopt).IAE;
        EXPECT_NEAR(error_integrals(usual.nodes, c.in.r, std::nullopt).IAE / IAE, 1, 1e-5);
        EXPECT_NEAR(total_variation(usual.nodes) / total_variation(tight.nodes), 1, 1e-4);
    }
}

TEST(TrackingTime, FollowsTheControllerOrThePlant) {
    const auto plant = made(Fopdt{.K = -4, .T = 2, .L = 1});
    EXPECT_DOUBLE_EQ(tracking_time(plant, {.Kp = -2, .Ki = -0.5}), 4);         // Ti
    EXPECT_DOUBLE_EQ(tracking_time(plant, {.Kp = 2, .Ki = 0.5, .Kd = 2}), 2);  // sqrt(Ti Td), Ti = 4, Td = 1
    EXPECT_DOUBLE_EQ(tracking_time(plant, {.Ki = -0.1}), 0.3);                 // (L + T)/10
    EXPECT_DOUBLE_EQ(tracking_time(made(Fopdt{.K = -4, .T = 0, .L = 0}), {.Ki = -0.5}), 0.05);
    EXPECT_EQ(tracking_time(plant, {.Kp = -2}), kInfinity);
}

}  // namespace
}  // namespace tunewright
