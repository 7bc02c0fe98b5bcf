// The final value of a loop: the closed form compared with the equations of the loop's states.
#include "engine/simulation/linear/response_end.h"

#include <gtest/gtest.h>

namespace tunewright {
namespace {

const std::vector<Plant> kPlants = {Fopdt{.K = 2, .T = 10, .L = 3}, Sopdt{.K = -0.4, .T1 = 5, .T2 = 2, .L = 0},
                                    Zpk{.K = 1.5, .zeros = {0.3}, .poles = {-1.0, -0.2, 0.0}, .L = 1},
                                    Zpk{.K = 2, .zeros = {-4.0}, .poles = {-1.0}, .L = 0.5},
                                    Zpk{.K = 1, .zeros = {}, .poles = {{-0.1, 1}, {-0.1, -1}, 0.2}, .L = 0.1}};

TEST(SteadyOutputs, AreThoseOfTheStates) {
    using enum FilterType;
    int compared = 0;
    for (const auto& plant : kPlants) {
        const auto linear = LinearPlant::make(plant);
        ASSERT_TRUE(linear);
        for (const FilterType filter : {none, measurement_first_order, measurement_second_order, derivative})
            for (const double lag : {0.0, 1.7}) {
                ParallelPid pid{.Kp = 0.8, .Ki = 0.11, .Kd = 0.9, .b = 0.6, .c = 0, .filter = {filter, 0.25}};
                if (filter == none) {
                    pid.filter = {};
                    pid.Kd = 0;
                }
                pid.setpoint_lag = lag;
                for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, 1}, StepInputs{-2, 0.3}}) {
                    const SteadyState states = steady_state(*linear, pid, in),
                                      closed = steady_outputs(*linear, pid, in);
                    ASSERT_TRUE(states.exists && closed.exists);
                    EXPECT_NEAR(closed.y, states.y, 1e-9);
                    EXPECT_NEAR(closed.u, states.u, 1e-9 * (1 + std::abs(states.u)));
                    ASSERT_TRUE(states.error_integral && closed.error_integral);
                    EXPECT_NEAR(*closed.error_integral, *states.error_integral,
                                1e-9 * (1 + std::abs(*states.error_integral)));
                    ++compared;
                }
            }
    }
    EXPECT_EQ(compared, 5 * 4 * 2 * 3);
}

TEST(SteadyOutputs, WithoutIntegralActionAreThoseOfTheStates) {
    const auto linear = LinearPlant::make(Fopdt{.K = 2, .T = 10, .L = 3});
    const ParallelPid pid{.Kp = 0.8};
    const SteadyState states = steady_state(*linear, pid, {1, 0.5}), closed = steady_outputs(*linear, pid, {1, 0.5});
    EXPECT_EQ(closed.y, states.y);
    EXPECT_EQ(closed.u, states.u);
    EXPECT_FALSE(closed.error_integral.has_value());
}

}  // namespace
}  // namespace tunewright
