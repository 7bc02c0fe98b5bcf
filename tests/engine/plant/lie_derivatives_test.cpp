// Relative degrees and Lie derivatives against formulas derived by hand.
#include "engine/plant/lie_derivatives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

TEST(LieDerivatives, CstrHasRelativeDegreeOneForTAndTwoForCA) {
    EXPECT_EQ(*relative_degree(made_system(cstr("T"))), 1);
    EXPECT_EQ(*relative_degree(made_system(cstr("CA"))), 2);
}

TEST(LieDerivatives, ReducedCstrFormulas) {
    const double CA = 0.61, T = 405.5;
    const double k = 4.71e8 * std::exp(-8000 / T), dk = k * 8000 / (T * T);
    const double f1 = (1 - CA) - k * CA, f2 = (400 - T) - 200 * k * CA - T;  // Tj's coefficient is 1
    LieDerivatives lie;
    ASSERT_TRUE(lie_derivatives(made_system(cstr("T")), 1, std::vector{CA, T}, lie));
    EXPECT_DOUBLE_EQ(lie.of_f[0], T);
    EXPECT_NEAR(lie.of_f[1], f2, 1e-12 * 800);
    EXPECT_DOUBLE_EQ(lie.of_g, 1);
    ASSERT_TRUE(lie_derivatives(made_system(cstr("CA")), 2, std::vector{CA, T}, lie));
    EXPECT_NEAR(lie.of_f[1], f1, 1e-14);
    EXPECT_NEAR(lie.of_f[2], (-1 - k) * f1 - dk * CA * f2, 1e-12);
    EXPECT_NEAR(lie.of_g, -dk * CA, 1e-15);
}

}  // namespace
}  // namespace tunewright
