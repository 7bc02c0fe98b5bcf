// The full revised IMC controller over time, for a model with almost no dead time.
#include "engine/simulation/imc/imc_response.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tunewright {
namespace {

TEST(ImcResponse, AVanishingDeadTimeOfTheModelIsALimitLikeAnyOther) {
    const auto plant = LinearPlant::make(Fopdt{.K = 2, .T = 5, .L = 1});
    const auto response = [&](double theta) {
        ImcController c;
        c.kp = 2;
        c.tau = 6;
        c.theta = theta;
        c.lambda = 3;
        c.beta = 4;
        return simulate_imc(*plant, c, {.r = 1, .d = 0.5}, {});
    };
    const StepResponse min = response(1e-13), small = response(1e-4);
    ASSERT_TRUE(min.settles && small.settles);
    for (const double t : {0.0, 1.0, 2.0, 5.0, 10.0, 20.0}) {
        const auto at = [&](const StepResponse& r) {
            const auto node = std::ranges::upper_bound(r.nodes, t + 1e-9, {}, &ResponseNode::t) - 1;
            return node->y + (t - node->t) * node->y_slope;
        };
        EXPECT_NEAR(at(min), at(small), 2e-2) << t;
    }
    EXPECT_NEAR(min.nodes.back().error_integral, small.nodes.back().error_integral, 1e-3);
}

}  // namespace
}  // namespace tunewright
