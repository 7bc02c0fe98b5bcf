// The loop with input/output linearisation: its output is that of the linear target, its input that of the paper's
// plant.
#include "engine/simulation/nonlinear/linearising_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

// Response of beta_2 y'' + beta_1 y' + y = 1, two real time constants.
double overdamped(double t, double tau, double xi) {
    const double root = std::sqrt(xi * xi - 1), slow = tau * (xi + root), fast = tau * (xi - root);
    return 1 - (slow * std::exp(-t / slow) - fast * std::exp(-t / fast)) / (slow - fast);
}

TEST(LinearisingResponse, CstrTemperatureFollowsTheFirstOrderTarget) {
    const auto system = made_system(cstr("T"));
    for (const double r : {-10.0, 10.0, 30.0}) {
        const LinearisingOptions options{.horizon = 10, .samples = 1001};
        const auto response = simulate_linearising(system, first_order_target(0.25), r, options, {});
        ASSERT_EQ(response.ended, "");
        EXPECT_FALSE(response.limited);
        ASSERT_EQ(response.even.y.size(), 1001U);
        ASSERT_EQ(response.even.u.size(), 1001U);
        for (std::size_t i = 0; i <= 1000; ++i)
            ASSERT_NEAR(response.even.y[i], r * (1 - std::exp(-0.01 * static_cast<double>(i) / 0.25)),
                        1e-8 * std::abs(r))
                << i;
        EXPECT_NEAR(response.even.u[0], 4 * r, 1e-10);
    }
}

TEST(LinearisingResponse, CstrConcentrationFollowsTheSecondOrderTarget) {
    const auto system = made_system(cstr("CA"));
    for (const double r : {-0.05, 0.005, 0.1416}) {
        const LinearisingOptions options{.horizon = 2, .samples = 401};
        const auto response = simulate_linearising(system, second_order_target(0.2, 1.05), r, options, {});
        ASSERT_EQ(response.ended, "");
        for (std::size_t i = 0; i <= 400; ++i)
            ASSERT_NEAR(response.even.y[i], r * overdamped(0.005 * static_cast<double>(i), 0.2, 1.05),
                        1e-8 * std::abs(r))
                << i;
    }
}

struct Published {
    const char* output;
    double r, IAE, settling, u_start, u_max, u_min;
};

// The independent reference's loops (DOP853, relative tolerance 1e-11), per unit of r.
constexpr Published kPublished[] = {
    {"T", -10, 0.25, 0.9780065043, -40, -40, -52.18996647},
    {"T", 5, 0.25, 0.9780065043, 20, 28.72747856, 20},
    {"T", 10, 0.25, 0.9780065043, 40, 59.14277528, 40},
    {"T", 20, 0.25, 0.9780065043, 80, 124.5546731, 80},
    {"CA", -0.05, 0.42, 1.2780284592, 51.8505767311, 51.8505767311, 18.0464442094},
    {"CA", 0.05, 0.42, 1.2780284592, -51.8505767311, -17.9516694722, -52.0453268652},
    {"CA", 0.14, 0.42, 1.2780284592, -145.18161485, -50.5593931050, -167.4733866869},
};

TEST(LinearisingResponse, ReferenceLoopsOfTheCstr) {
    for (const auto& row : kPublished) {
        const bool first = std::string(row.output) == "T";
        const auto system = made_system(cstr(row.output));
        const double horizon = first ? 10 : 8, dt = horizon / 16000;
        const auto target = first ? first_order_target(0.25) : second_order_target(0.2, 1.05);
        const auto [even, limited, t_end, ended] =
            simulate_linearising(system, target, row.r, {.horizon = horizon, .samples = 16001}, {});
        ASSERT_EQ(ended, "");
        EXPECT_EQ(t_end, horizon);
        double IAE = 0, settling = 0, overshoot = 0;
        for (std::size_t i = 0; i < even.y.size(); ++i) {
            const double error = 1 - even.y[i] / row.r;
            IAE += std::abs(error) * (i == 0 ? dt / 2 : dt);
            overshoot = std::max(overshoot, -error);
            if (std::abs(error) > 0.02) settling = static_cast<double>(i) * dt;
        }
        EXPECT_NEAR(IAE, row.IAE, 1e-6);
        EXPECT_NEAR(settling, row.settling, dt);
        EXPECT_LT(overshoot, 1e-9);
        EXPECT_NEAR(even.u[0], row.u_start, 1e-8 * std::abs(row.u_start));
        EXPECT_NEAR(*std::max_element(even.u.begin(), even.u.end()), row.u_max, 2e-3 * std::abs(row.u_max));
        EXPECT_NEAR(*std::min_element(even.u.begin(), even.u.end()), row.u_min, 2e-3 * std::abs(row.u_min));
    }
}

// The paper's law for T, with limits, by Runge-Kutta steps so short that the kinks do not matter.
double clipped_temperature(double r, double gamma, double low, double high, double end) {
    const auto system = made_system(cstr("T"));
    double CA = system.x_steady()[0], T = system.x_steady()[1];
    const double T_steady = T;
    const auto rates = [&](double c, double t, double& dc, double& dt) {
        const double k = 4.71e8 * std::exp(-8000 / t), drift = (400 - t) - 200 * k * c - t;
        const double u = std::clamp((r - (t - T_steady) - gamma * drift) / gamma, low, high);
        dc = 1 - c - k * c;
        dt = drift + u;
    };
    constexpr int kSteps = 200000;
    const double h = end / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        double c1, t1, c2, t2, c3, t3, c4, t4;
        rates(CA, T, c1, t1);
        rates(CA + h / 2 * c1, T + h / 2 * t1, c2, t2);
        rates(CA + h / 2 * c2, T + h / 2 * t2, c3, t3);
        rates(CA + h * c3, T + h * t3, c4, t4);
        CA += h / 6 * (c1 + 2 * c2 + 2 * c3 + c4);
        T += h / 6 * (t1 + 2 * t2 + 2 * t3 + t4);
    }
    return T - T_steady;
}

TEST(LinearisingResponse, LimitsClipTheInputAndAreReported) {
    auto plant = cstr("T");
    plant.input.min = 493.87 - 10;
    plant.input.max = 493.87 + 50;
    const auto system = made_system(plant);
    for (const double end : {0.05, 1.0, 2.0}) {
        const auto response =
            simulate_linearising(system, first_order_target(0.25), 10, {.horizon = end, .samples = 101}, {});
        EXPECT_NEAR(response.even.y.back(), clipped_temperature(10, 0.25, 493.87 - 10, 493.87 + 50, end), 1e-8) << end;
        EXPECT_EQ(response.limited, end > 0.5);
        EXPECT_LE(*std::max_element(response.even.u.begin(), response.even.u.end()), 50 + 1e-10);
    }
    const auto down = simulate_linearising(system, first_order_target(0.25), -10, {.horizon = 1}, {});
    EXPECT_TRUE(down.limited);
    EXPECT_NEAR(down.even.u[0], -10, 1e-10);
    EXPECT_NEAR(down.even.y.back(), clipped_temperature(-10, 0.25, 493.87 - 10, 493.87 + 50, 1), 1e-8);
}

TEST(LinearisingResponse, AnInputThatSettlesOnItsLimitEnds) {
    auto plant = cstr("T");
    const double rest =
        simulate_linearising(made_system(plant), first_order_target(0.25), -10, {.horizon = 40}, {}).even.u.back();
    plant.input.min = 493.87 + rest;
    const auto response = simulate_linearising(made_system(plant), first_order_target(0.25), -10, {.horizon = 40}, {});
    EXPECT_EQ(response.ended, "");
    EXPECT_NEAR(response.even.y.back(), -10, 1e-6);
}

TEST(LinearisingResponse, DeadTimeDelaysTheOutputAndNothingElse) {
    auto plant = cstr("CA");
    const LinearisingOptions options{.horizon = 2, .samples = 401};
    const auto target = second_order_target(0.2, 1.05);
    const auto prompt = simulate_linearising(made_system(plant), target, 0.05, options, {});
    plant.L = 0.25;
    const auto late = simulate_linearising(made_system(plant), target, 0.05, options, {});
    ASSERT_EQ(late.even.y.size(), 401U);
    for (std::size_t i = 0; i < 401; ++i) {
        EXPECT_NEAR(late.even.u[i], prompt.even.u[i], 1e-9);
        EXPECT_NEAR(late.even.y[i], i < 50 ? 0 : prompt.even.y[i - 50], 1e-12);
    }
}

TEST(LinearisingResponse, FromOtherStatesTheMotionIsFreeUntilTheDeadTimeIsOver) {
    auto plant = cstr("T");
    plant.L = 0.2;
    const auto system = made_system(plant);
    const LinearisingOptions options{.horizon = 2, .samples = 201, .initial = {0.52, 405}};
    const auto response = simulate_linearising(system, first_order_target(0.25), 3, options, {});
    ASSERT_EQ(response.ended, "");
    EXPECT_NEAR(response.even.y[0], 405 - system.y_steady(), 1e-12);
    const double start = response.even.y[20];  // at t = L
    EXPECT_LT(start, response.even.y[0] - 1);
    for (std::size_t i = 20; i < 201; ++i)
        EXPECT_NEAR(response.even.y[i], 3 + (start - 3) * std::exp(-0.01 * static_cast<double>(i - 20) / 0.25), 1e-8);
}

TEST(LinearisingResponse, HigherRelativeDegreesFollowTheirPoles) {
    NonlinearPlant chain{.states = {{"x1", 1}, {"x2", 1}, {"x3", 1}},
                         .parameters = {},
                         .equations = {{"x1", "x2^2 - x1"}, {"x2", "exp(x3 - 1) - x2"}, {"x3", "u - x3^3"}},
                         .input = {.name = "u", .nominal = 1},
                         .output = "x1"};
    const auto system = made_system(chain);
    ASSERT_EQ(*relative_degree(system), 3);
    const auto target = target_of_poles({{-2, 3}, {-2, -3}, {-1, 0}});
    ASSERT_EQ(target.beta.size(), 4U);
    EXPECT_NEAR(target.beta[3], 1.0 / 13, 1e-15);
    EXPECT_NEAR(target.beta[1], 1 + 4.0 / 13, 1e-15);
    const auto response = simulate_linearising(system, target, 0.2, {.horizon = 6, .samples = 301}, {});
    ASSERT_EQ(response.ended, "");
    // Residues of 13/(s (s + 1) (s^2 + 4 s + 13)): 1 at 0, -13/10 at -1, the pair by value and slope at t = 0.
    for (std::size_t i = 0; i < 301; ++i) {
        const double t = 0.02 * static_cast<double>(i);
        const double y =
            1 - 1.3 * std::exp(-t) + std::exp(-2 * t) * (0.3 * std::cos(3 * t) - 0.7 / 3 * std::sin(3 * t));
        ASSERT_NEAR(response.even.y[i], 0.2 * y, 2e-9) << t;
    }
}

TEST(LinearisingResponse, EndsAreSaid) {
    const auto ended = [](const NonlinearPlant& plant, double r) {
        const auto response = simulate_linearising(made_system(plant), first_order_target(0.5), r, {.horizon = 40}, {});
        EXPECT_LT(response.t_end, 40);
        EXPECT_EQ(response.even.y.size(), response.even.u.size());
        for (const double u : response.even.u) EXPECT_TRUE(std::isfinite(u));
        return response.ended;
    };
    auto tank = spherical_tank(0.49, 0.28);
    tank.input.min = tank.input.max = std::nullopt;
    EXPECT_THAT(ended(tank, -0.6), testing::HasSubstr("the states leave the model's domain. Equation h"));
    EXPECT_THAT(ended(scalar_plant("-x + cos(x)*u", 0), 2),
                testing::HasSubstr("the controller's law becomes undefined"));
    NonlinearPlant inverse{.states = {{"x1", 0}, {"x2", 0}},
                           .parameters = {},
                           .equations = {{"x1", "-x1 + u"}, {"x2", "-2*x2 - 1.5*u"}},
                           .input = {.name = "u", .nominal = 0},
                           .output = "x1 + x2"};
    EXPECT_THAT(ended(inverse, 1), testing::HasSubstr("the input is unbounded: the plant's zero dynamics"));
}

// The tank's area is zero at its tip, where the input has no effect.
TEST(LinearisingResponse, EndsWhereAConicalTankIsAskedToBeLessThanEmpty) {
    const auto system = made_system({.states = {{"h", 1}},
                                     .parameters = {{"k", 0.6}, {"c", 0.2}},
                                     .equations = {{"h", "(q - k*sqrt(h))/(c*h^2)"}},
                                     .input = {.name = "q", .nominal = 0.6},
                                     .output = "h"});
    const auto response = simulate_linearising(system, first_order_target(1), -1.2, {.horizon = 8, .samples = 801}, {});
    EXPECT_THAT(response.ended, testing::HasSubstr("the states leave the model's domain. Equation h"));
    EXPECT_NEAR(response.t_end, std::log(6), 1e-3);  // 1.2 e^-t = 0.2
    for (std::size_t i = 0; i < response.even.y.size(); ++i)
        ASSERT_NEAR(response.even.y[i], -1.2 * (1 - std::exp(-0.01 * static_cast<double>(i))), 1e-7) << i;
}

TEST(LinearisingResponse, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    const auto response = simulate_linearising(made_system(cstr("T")), first_order_target(0.25), 10, {.horizon = 10},
                                               {.stop = source.get_token(), .progress = {}, .now_ms = {}});
    EXPECT_EQ(response.ended, "The simulation was stopped.");
    EXPECT_EQ(response.t_end, 0);
}

}  // namespace
}  // namespace tunewright
