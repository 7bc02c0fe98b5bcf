// A program that takes over from manual does so without a bump, whatever its rules.
#include <gtest/gtest.h>

#include "engine/controller/sampled/pid_program.h"

namespace tunewright {
namespace {

TEST(PidProgram, TakesOverWithoutABump) {
    constexpr double r = 52, y = 50, u = 37;
    for (const auto derivative :
         {DerivativeRule::difference, DerivativeRule::filtered_backward, DerivativeRule::filtered_forward,
          DerivativeRule::filtered_trapezoidal, DerivativeRule::slope, DerivativeRule::four_points})
        for (const auto filter : {FilterType::none, FilterType::derivative, FilterType::measurement_first_order,
                                  FilterType::measurement_second_order})
            for (const bool velocity : {false, true}) {
                const SampledPid law{.gains = {.Kp = 1.5,
                                               .Ki = 0.2,
                                               .Kd = 4,
                                               .b = 0.6,
                                               .c = 0.3,
                                               .filter = {filter, filter == FilterType::none ? 0 : 3.0},
                                               .setpoint_lag = 2},
                                     .Ts = 0.5,
                                     .derivative = derivative,
                                     .slope_samples = 4,
                                     .velocity = velocity,
                                     .trapezoidal_filter = derivative == DerivativeRule::filtered_trapezoidal};
                PidProgram program(law);
                program.take_over(r, y, u);
                // Only the integral moves u while r and y stay.
                for (int k = 1; k <= 5; ++k) EXPECT_NEAR(program.step(r, y), u + k * 0.2 * 0.5 * (r - y), 1e-9);
            }
}

TEST(PidProgram, TakesOverWithLimitsOfTheOutputItself) {
    const SampledPid law{.gains = {.Kp = 1, .Ki = 0.5, .b = 1}, .Ts = 1};
    PidProgram program(law, {.output = ActuatorLimits{0, 100}});
    program.take_over(50, 50, 99);
    EXPECT_DOUBLE_EQ(program.step(55, 50), 100);
    EXPECT_NEAR(program.step(50, 50), 99, 1e-12);  // nothing has wound up
}

}  // namespace
}  // namespace tunewright
