// The loop under input/output linearisation: its output is the linear target's, its input what the paper's plant needs.
#include "engine/simulation/linearising_response.h"

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

}  // namespace
}  // namespace tunewright
