// A linear plant written as equations is the same plant.
#include <cmath>

#include "engine/plant/nonlinear/linearisation.h"

#include <gtest/gtest.h>

#include "engine/plant/nonlinear/lie_derivatives.h"

namespace tunewright {
namespace {

LinearPlant linear_form(const Plant& plant) { return LinearPlant::make(plant).value(); }

TEST(LinearEquations, LinearisationGivesTheTransferFunctionBack) {
    for (const Plant& plant : {Plant(Fopdt{.K = -2, .T = 3, .L = 0.5}), Plant(Ipdt{.K = 0.1, .L = 1, .T = 2}),
                               Plant(TransferFunction{.num = {0.7, 1}, .den = {1, 6, 11, 6}, .L = 0}),
                               Plant(TransferFunction{.num = {1}, .den = {1, 8, 28, 56, 70, 56, 28, 8, 1}, .L = 2})}) {
        const LinearPlant linear = linear_form(plant);
        const auto system = as_equations(linear);
        ASSERT_TRUE(system.has_value()) << system.error().message;
        const LinearPlant back = linear_form(system->linearised());
        EXPECT_EQ(back.dead_time(), linear.dead_time());
        EXPECT_EQ(*relative_degree(*system), linear.pole_excess());
        for (const double omega : {0.03, 0.5, 2.0})
            EXPECT_LT(std::abs(back.at({0, omega}) - linear.at({0, omega})), 1e-9 * std::abs(linear.at({0, omega})));
    }
}

TEST(LinearEquations, ADirectTermIsRefused) {
    for (const Plant& plant :
         {Plant(Fopdt{.K = 2, .T = 0, .L = 1}), Plant(TransferFunction{.num = {1, 2}, .den = {1, 1}, .L = 0})}) {
        const auto system = as_equations(linear_form(plant));
        ASSERT_FALSE(system.has_value());
        EXPECT_EQ(system.error().kind, ErrorKind::unsupported);
        EXPECT_NE(system.error().message.find("direct term"), std::string::npos);
    }
}

}  // namespace
}  // namespace tunewright
