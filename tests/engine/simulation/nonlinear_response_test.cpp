#include "engine/simulation/nonlinear/nonlinear_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/plant/nonlinear/linearisation.h"
#include "engine/simulation/linear/indices.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

NonlinearSystem written_out(const Plant& plant) { return *as_equations(*LinearPlant::make(plant)); }

/// The largest difference of y and u at even times, relative to the largest values.
double difference(const NonlinearResponse& a, const StepResponse& b, double horizon) {
    const auto values = sampled(b.nodes, horizon, int(a.even.y.size()));
    double dy = 0, du = 0, y = 0, u = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        dy = std::max(dy, std::abs(a.even.y[i] - values[i].first));
        du = std::max(du, std::abs(a.even.u[i] - values[i].second));
        y = std::max(y, std::abs(values[i].first));
        u = std::max(u, std::abs(values[i].second));
    }
    return std::max(dy / y, du / u);
}

/// `tolerance` is wider if the linear simulation's own steps are coarse after an impulse.
struct LinearCase {
    const char* name;
    Plant plant;
    ParallelPid controller;
    StepInputs inputs;
    double horizon;
    double tolerance = 1e-6;
};

std::vector<LinearCase> linear_cases() {
    const Zpk third{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0}, .L = 0.3};
    const Filter derivative{FilterType::derivative, 0.1}, first{FilterType::measurement_first_order, 0.2},
        second{FilterType::measurement_second_order, 0.3};
    return {
        {"PI, no dead time", Fopdt{.K = 2, .T = 3, .L = 0}, {.Kp = 1, .Ki = 0.5}, {1, 0}, 20},
        {"PI, load", Fopdt{.K = 2, .T = 3, .L = 1}, {.Kp = 0.7, .Ki = 0.25}, {0, 1}, 30},
        {"PI, dead time, half the step", Fopdt{.K = 2, .T = 3, .L = 1}, {.Kp = 0.7, .Ki = 0.25, .b = 0.5}, {1, 0}, 30},
        {"I alone", Fopdt{.K = 2, .T = 3, .L = 1}, {.Ki = 0.1}, {1, 0.5}, 40},
        {"P alone", third, {.Kp = 2}, {1, 0}, 20},
        {"PID, filtered derivative", third, {.Kp = 2, .Ki = 0.7, .Kd = 1.5, .filter = derivative}, {1, 0}, 20},
        {"PID, kick", third, {.Kp = 2, .Ki = 0.7, .Kd = 1.5, .c = 1, .filter = derivative}, {1, 0}, 20, 3e-6},
        {"PID, measurement filter", third, {.Kp = 2, .Ki = 0.7, .Kd = 1, .filter = first}, {1, 1}, 20},
        {"PID, second-order filter", third, {.Kp = 2, .Ki = 0.7, .Kd = 1, .filter = second}, {1, 1}, 20},
        {"PID, pure derivative", third, {.Kp = 2, .Ki = 0.7, .Kd = 1.5}, {1, 0}, 20},
        {"PID, pure derivative against y' of the step",
         Fopdt{.K = 1, .T = 2, .L = 0},
         {.Kp = 3, .Ki = 2, .Kd = 0.8},
         {1, 0},
         10},
        {"PID, neutral", Fopdt{.K = 1, .T = 2, .L = 0.5}, {.Kp = 1.5, .Ki = 0.7, .Kd = 0.5}, {1, 0}, 10},
        {"PI, integrating", Ipdt{.K = 0.5, .L = 0.4}, {.Kp = 1.5, .Ki = 0.3}, {1, 1}, 30},
        {"PID, unstable plant",
         Zpk{.K = 2, .zeros = {}, .poles = {0.5, -3.0}, .L = 0.1},
         {.Kp = 4, .Ki = 1, .Kd = 1, .filter = derivative},
         {1, 1},
         20},
    };
}

TEST(NonlinearResponse, OfALinearPlantIsTheLinearOne) {
    for (const LinearCase& c : linear_cases()) {
        SCOPED_TRACE(c.name);
        ResponseOptions exact;
        exact.tolerance = 1e-8;
        exact.horizon = c.horizon;
        const auto linear = simulate_linear(*LinearPlant::make(c.plant), c.controller, c.inputs, exact);
        NonlinearOptions options;
        options.horizon = c.horizon;
        options.samples = 401;
        const auto response = simulate_nonlinear(written_out(c.plant), c.controller, c.inputs, options);
        ASSERT_EQ(response.ended, "");
        ASSERT_EQ(response.even.y.size(), 401u);
        EXPECT_LT(difference(response, linear, c.horizon), c.tolerance);
        EXPECT_FALSE(response.limited);
    }
}

TEST(NonlinearResponse, OfALinearPlantWithLimitsIsTheLimitedOne) {
    for (const LinearCase& c : linear_cases()) {
        if (std::string(c.name).find("unstable") != std::string::npos) continue;
        SCOPED_TRACE(c.name);
        ResponseOptions exact;
        exact.tolerance = 1e-8;
        exact.horizon = c.horizon;
        const auto plant = *LinearPlant::make(c.plant);
        const auto free = simulate_linear(plant, c.controller, c.inputs, exact);
        double max = 0, min = 0;
        for (const auto& node : free.nodes) {
            max = std::max(max, node.u);
            min = std::min(min, node.u);
        }
        const ActuatorLimits limits{min - 0.1, std::max(0.7 * max, 1.1 * free.u_final)};
        if (limits.max >= max) continue;
        const auto linear = simulate_limited(plant, c.controller, c.inputs, limits, exact);
        NonlinearOptions options;
        options.horizon = c.horizon;
        options.samples = 401;
        options.actuator = limits;
        const auto response = simulate_nonlinear(written_out(c.plant), c.controller, c.inputs, options);
        ASSERT_EQ(response.ended, "");
        EXPECT_TRUE(response.limited);
        EXPECT_LT(difference(response, linear, c.horizon), c.tolerance);
    }
}

TEST(NonlinearResponse, TakesStepsFarBeyondATinyDeadTime) {
    const ParallelPid controller{.Kp = 2, .Ki = 0.7, .Kd = 1.5, .filter = {FilterType::derivative, 0.1}};
    ResponseOptions exact;
    exact.tolerance = 1e-8;
    exact.horizon = 20;
    for (const double L : {1e-2, 1e-4, 1e-6})
        for (const double limit : {HUGE_VAL, 1.6}) {
            const Zpk plant{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0}, .L = L};
            NonlinearOptions options;
            options.horizon = 20;
            options.samples = 401;
            options.max_steps = 3000;
            options.actuator = ActuatorLimits{-limit, limit};
            const auto response = simulate_nonlinear(written_out(plant), controller, {1, 0}, options);
            ASSERT_EQ(response.ended, "");
            const auto linear = simulate_limited(*LinearPlant::make(plant), controller, {1, 0}, {-limit, limit}, exact);
            EXPECT_LT(difference(response, linear, 20), 2e-6) << L;
        }
}

TEST(NonlinearResponse, RunsUntilItIsAtRestAndClosesTheTail) {
    const auto system = made_system(cstr("T"));
    const ParallelPid pi{.Kp = 1.81, .Ki = 1.81 / 0.403};
    const auto response = simulate_nonlinear(system, pi, {-10, 5}, {});
    ASSERT_TRUE(response.loop.settles);
    EXPECT_EQ(response.loop.y_final, -10);
    // Steady state: f = 0 at T - 10, where the first equation gives CA and the second Tj.
    const double T = system.y_steady() - 10, k = 4.71e8 * std::exp(-8000 / T), CA = 1 / (1 + k);
    EXPECT_NEAR(response.loop.u_final, 2 * T - 400 + 200 * k * CA - 493.87 - 5, 1e-9);
    ASSERT_TRUE(response.loop.error_integral_final);
    EXPECT_NEAR(*response.loop.error_integral_final, response.loop.u_final / pi.Ki, 1e-7);
    NonlinearOptions longer;
    longer.horizon = 40;
    const auto far = simulate_nonlinear(system, pi, {-10, 5}, longer);
    EXPECT_NEAR(integral_of_absolute_error(response.loop.nodes, -10, response.loop.error_integral_final),
                integral_of_absolute_error(far.loop.nodes, -10, std::nullopt), 1e-6);
    const auto by_filter = [&](FilterType type) {
        ParallelPid filtered = pi;
        filtered.Kd = 0.1;
        filtered.filter = {type, 0.05};
        const auto r = simulate_nonlinear(system, filtered, {-10, 5}, {});
        const auto to_40 = simulate_nonlinear(system, filtered, {-10, 5}, longer);
        EXPECT_NEAR(*r.loop.error_integral_final, to_40.loop.nodes.back().error_integral, 1e-6);
    };
    by_filter(FilterType::measurement_first_order);
    by_filter(FilterType::measurement_second_order);
}

TEST(NonlinearResponse, WithoutIntegralActionRestsWhereTheLawDoes) {
    const auto response = simulate_nonlinear(made_system(cstr("T")), {.Kp = 5}, {10, 0}, {});
    ASSERT_TRUE(response.loop.settles);
    EXPECT_FALSE(response.loop.error_integral_final);
    EXPECT_NEAR(response.loop.u_final, 5 * (10 - response.loop.y_final), 1e-9);
    EXPECT_NEAR(response.loop.nodes.back().y, response.loop.y_final, 1e-5);
}

TEST(NonlinearResponse, RestsAtALimitThatTheSetPointIsBeyond) {
    NonlinearOptions options;
    options.actuator = ActuatorLimits{-20, 20};
    const auto response = simulate_nonlinear(made_system(cstr("T")), {.Kp = 5, .Ki = 20}, {10, 0}, options);
    ASSERT_TRUE(response.loop.settles);
    EXPECT_TRUE(response.limited);
    EXPECT_EQ(response.loop.u_final, 20);
    EXPECT_FALSE(response.loop.error_integral_final);
    EXPECT_NEAR(response.loop.nodes.back().y, response.loop.y_final, 1e-5);
    EXPECT_LT(response.loop.y_final, 5);
}

TEST(NonlinearResponse, EndsEarlyWithAReason) {
    // A tank with a constant outflow and an outlet: a load removes more than flows in.
    const auto tank = made_system(scalar_plant("u-0.5-sqrt(x)", 1, 1.5));
    const auto empty = simulate_nonlinear(tank, {.Kp = 0.1, .Ki = 0.01}, {0, -1.4}, {});
    EXPECT_TRUE(empty.escaped);
    EXPECT_FALSE(empty.loop.settles);
    EXPECT_EQ(empty.ended.find("At t = "), 0u) << empty.ended;
    EXPECT_NE(empty.ended.find("sqrt of"), std::string::npos) << empty.ended;

    const auto unstable = simulate_nonlinear(tank, {.Kp = -9, .Ki = -1}, {0.1, 0}, {});
    EXPECT_TRUE(unstable.escaped);

    NonlinearOptions few;
    few.max_steps = 10;
    few.horizon = 10;
    few.samples = 101;
    const auto cut = simulate_nonlinear(tank, {.Kp = 0.1, .Ki = 0.01}, {0.1, 0}, few);
    EXPECT_NE(cut.ended.find("the limit of 10 steps"), std::string::npos) << cut.ended;
    EXPECT_LT(cut.even.y.size(), 101u);
    EXPECT_LT(cut.t_end, 10);

    std::stop_source source;
    source.request_stop();
    NonlinearOptions stopped;
    stopped.stop = source.get_token();
    EXPECT_EQ(simulate_nonlinear(tank, {.Kp = 0.1}, {0.1, 0}, stopped).ended, "The simulation was stopped.");

    // 1 + Kd C B < 0: at a limit the derivative's loop has several solutions.
    NonlinearOptions limited;
    limited.actuator = ActuatorLimits{-300, 300};
    const auto crowded =
        simulate_nonlinear(made_system(cstr("T")), {.Kp = -4.4, .Ki = -2, .Kd = -1.8}, {5, 0}, limited);
    EXPECT_NE(crowded.ended.find("Give the derivative a filter"), std::string::npos) << crowded.ended;
}

TEST(NonlinearResponse, KeepsEvenSamplesWithoutNodes) {
    const auto system = made_system(cstr("T"));
    NonlinearOptions options;
    options.horizon = 2;
    options.samples = 51;
    const auto both = simulate_nonlinear(system, {.Kp = 4.8, .Ki = 25}, {10, 0}, options);
    options.nodes = false;
    const auto alone = simulate_nonlinear(system, {.Kp = 4.8, .Ki = 25}, {10, 0}, options);
    EXPECT_TRUE(alone.loop.nodes.empty());
    EXPECT_EQ(alone.even.y, both.even.y);
    EXPECT_EQ(alone.even.u, both.even.u);
    EXPECT_EQ(both.even.u.front(), both.loop.nodes.front().u);
    const auto of_nodes = sampled(both.loop.nodes, 2, 51);
    for (std::size_t i = 0; i < of_nodes.size(); ++i) {
        EXPECT_NEAR(both.even.y[i], of_nodes[i].first, 1e-5);
        EXPECT_NEAR(both.even.u[i], of_nodes[i].second, 1e-4);
    }
}

TEST(NonlinearResponse, OfTheStirredTankHasTheReferencesFigures) {
    const Json reference = Json::parse(std::ifstream(test_data("emulation/closed_loops.json")));
    int rows = 0;
    for (const Json& row : reference.at("rows")) {
        if (!row.contains("params")) continue;
        ++rows;
        const std::string loop = row.at("loop");
        const double r = row.at("r");
        SCOPED_TRACE(loop + " " + row.at("tuning").get<std::string>() + " " + std::to_string(r));
        const auto params = row.at("params").get<std::vector<double>>();
        ParallelPid controller{.Kp = params[0], .Ki = params[0] / params[1]};
        if (params.size() > 2) {
            controller.Kd = params[0] * params[2];
            controller.filter = {FilterType::derivative, 0.1};
            controller.c = row.at("kick").get<bool>() ? 1 : 0;
        }
        NonlinearOptions options;
        options.horizon = reference.at("horizon_" + loop);
        const auto response = simulate_nonlinear(made_system(cstr(loop)), controller, {r, 0}, options);
        if (!row.at("stable")) {
            EXPECT_NE(response.ended.find("leave the model's domain"), std::string::npos) << response.ended;
            EXPECT_LT(response.t_end, *options.horizon);
            continue;
        }
        ASSERT_EQ(response.ended, "");
        const auto& nodes = response.loop.nodes;
        const double iae = integral_of_absolute_error(nodes, r, std::nullopt) / std::abs(r);
        const Extremes extremes = extremes_of_y(nodes);
        EXPECT_NEAR(iae, row.at("iae_over_r"), 1e-6);
        EXPECT_NEAR(std::max(0.0, (r > 0 ? extremes.max : extremes.min) / r - 1), row.at("overshoot"), 1e-5);
        const auto settled = last_outside(nodes, r, 0.02 * std::abs(r));
        ASSERT_EQ(settled.has_value(), !row.at("settling_2pct").is_null());
        if (settled) {
            EXPECT_NEAR(*settled, row.at("settling_2pct"), 1e-4);
        }
        double u_max = -INFINITY, u_min = INFINITY;
        for (const auto& node : nodes) {
            u_max = std::max(u_max, node.u);
            u_min = std::min(u_min, node.u);
        }
        EXPECT_NEAR(nodes.front().u, row.at("u0"), 1e-9 * std::abs(nodes.front().u));
        EXPECT_NEAR(u_max, row.at("u_max"), 2e-3 * (u_max - u_min));
        EXPECT_NEAR(u_min, row.at("u_min"), 2e-3 * (u_max - u_min));
    }
    EXPECT_GE(rows, 45);
}

}  // namespace
}  // namespace tunewright
