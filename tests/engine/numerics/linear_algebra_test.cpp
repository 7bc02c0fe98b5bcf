// Linear systems in any units.
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/matrix/eigenvalues.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tunewright {
namespace {

using Index = std::size_t;

TEST(MatrixScaling, SolvesWhateverTheUnitsOfEquationsAndUnknowns) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(-1, 1), decades(-45, 45);
    for (Index k = 0; k < 500; ++k) {
        const Index n = 1 + k % 9;
        std::vector<double> A(n * n), x(n), b(n, 0.0), rows(n), columns(n);
        for (double& a : A) a = size(random) < -0.4 ? 0 : size(random);
        for (Index i = 0; i < n; ++i) {
            A[i * n + i] += 2;
            x[i] = size(random);
            rows[i] = std::pow(10, decades(random));
            columns[i] = std::pow(10, decades(random));
        }
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) {
                b[i] += rows[i] * A[i * n + j] * x[j];
                A[i * n + j] *= rows[i] * columns[j];
            }
        const auto solved = solve(A, b, int(n));
        ASSERT_TRUE(solved);
        for (Index i = 0; i < n; ++i) EXPECT_NEAR((*solved)[i] * columns[i], x[i], 1e-11);
    }
}

TEST(MatrixScaling, SingularIsSingularInAnyUnits) {
    for (const double unit : {1e-30, 1.0, 1e30}) {
        EXPECT_FALSE(
            solve(std::vector<double>{unit, 2, 3, 2 * unit, 4, 6, unit, 0, 1}, std::vector<double>{1, 2, 3}, 3));
        EXPECT_FALSE(solve(std::vector<double>{unit, 0, 1, 0}, std::vector<double>{1, 2}, 2));
    }
}

TEST(MatrixScaling, NoEntryIsAboveOneAfterIt) {
    const std::vector<double> A = {1e-18, 1e9, 0, 3e-40, 1, 1e-200, 5e8, 2, 1e-9};
    const auto scaling = scaling_of(A, 3);
    ASSERT_TRUE(scaling);
    for (Index i = 0; i < 3; ++i)
        for (Index j = 0; j < 3; ++j) EXPECT_LE(std::abs(A[3 * i + j]) * scaling->rows[i] * scaling->columns[j], 2.0);
}

TEST(BalancedNorm, KnowsNoUnitsAndCountsNoChain) {
    // An oscillation of 2 rad per unit of time, with states whose units differ by 1e12; an integrator of it; a chain.
    const std::vector<double> A = {0, 2e-12, 0, -2e12, 0, 0, 1e20, 0, 0};
    EXPECT_NEAR(balanced_norm(A, 3), 2, 2);
    const std::vector<double> chain = {0, 0, 0, 1e9, 0, 0, 0, 1e9, 0};
    EXPECT_EQ(balanced_norm(chain, 3), 0);
}

}  // namespace
}  // namespace tunewright
