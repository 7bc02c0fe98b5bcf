// Multiple roots are merged to one point, and simple ones are left unchanged.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/numerics/polynomial_roots.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

std::vector<double> product_of(const std::vector<Complex>& roots) {
    std::vector<Complex> p{1.0};
    for (const Complex root : roots) {
        p.push_back(0);
        for (std::size_t i = p.size() - 1; i > 0; --i) p[i] -= root * p[i - 1];
    }
    std::vector<double> real;
    for (const Complex c : p) real.push_back(c.real());
    return real;
}

TEST(MultipleRoots, AreFoundAsGivenInAnyUnitOfTime) {
    for (const int m : {2, 3, 4, 5, 8})
        for (const double scale : {1e-9, 0.3, 1.0, 7.0, 1e9}) {
            const auto roots = polynomial_roots(product_of(std::vector<Complex>(std::size_t(m), -scale)));
            ASSERT_EQ(roots.size(), std::size_t(m));
            for (const Complex root : roots) EXPECT_LE(std::abs(root + scale), 1e-14 * scale) << m << " " << scale;
        }
}

TEST(MultipleRoots, AreFoundBesideOthersAndInPairs) {
    const std::vector<Complex> given = {{-1, 2}, {-1, -2}, {-1, 2}, {-1, -2}, -3.0, -3.0, -3.0, -40.0};
    auto roots = polynomial_roots(product_of(given));
    ASSERT_EQ(roots.size(), given.size());
    for (const Complex wanted : given) {
        const auto nearest = std::min_element(roots.begin(), roots.end(), [&](Complex a, Complex b) {
            return std::abs(a - wanted) < std::abs(b - wanted);
        });
        EXPECT_LE(std::abs(*nearest - wanted), 1e-12 * std::abs(wanted));
        roots.erase(nearest);
    }
}

// (s + 1)(0.005 s + 1)^2 expanded: one coefficient is wrong by one unit in its last place, which turns the double root
// into a pair so close that a Newton step would swap them.
TEST(MultipleRoots, ARoundedCoefficientLeavesTheOthersTheirs) {
    const auto roots = polynomial_roots(std::vector<double>{2.5e-05, 0.010025, 1.0099999999999998, 1.0});
    EXPECT_EQ(std::ranges::count_if(roots, [](Complex root) { return std::abs(root + 1.0) < 1e-12; }), 1);
    EXPECT_EQ(std::ranges::count_if(roots, [](Complex root) { return std::abs(root + 200.0) < 1e-3; }), 2);
}

TEST(PolynomialRoots, TheirProductIsThePolynomialWhateverItsRounding) {
    std::mt19937 random(11);
    std::uniform_real_distribution<> decades(-3, 3), damping(0.01, 1);
    std::uniform_int_distribution<> ulps(-4, 4), kind(0, 3), degree(3, 6);
    for (int n = 0; n < 20000; ++n) {
        std::vector<Complex> given;
        for (const auto size = std::size_t(degree(random)); given.size() < size;) {
            const double at = std::pow(10, decades(random)), zeta = damping(random);
            const Complex pair = -at * Complex(zeta, std::sqrt(1 - zeta * zeta));
            for (int times = kind(random) == 0 ? 1 : 2; times > 0; --times) {
                if (kind(random) > 0) {
                    given.push_back(-at);
                } else {
                    given.push_back(pair);
                    given.push_back(std::conj(pair));
                }
            }
        }
        std::vector<double> coefficients = product_of(given);
        for (double& c : coefficients) c *= 1 + ulps(random) * 1.1e-16;
        const auto roots = polynomial_roots(coefficients);
        ASSERT_EQ(roots.size(), given.size());
        std::vector<Complex> p{1.0};
        for (const Complex root : roots) {
            p.push_back(0);
            for (std::size_t i = p.size() - 1; i > 0; --i) p[i] -= root * p[i - 1];
        }
        for (std::size_t i = 0; i < p.size(); ++i)
            ASSERT_LE(std::abs(p[i] / coefficients[i] - 1.0), 1e-10) << "polynomial " << n << ", coefficient " << i;
    }
}

TEST(MultipleRoots, NearOnesStayApart) {
    // Coefficients that distinguish 1 and 1.00001, and four roots on a circle of radius 0.018 around -1.
    const auto two = polynomial_roots(std::vector<double>{1, 2.00001, 1.00001});
    EXPECT_NEAR(std::abs(two[0] - two[1]), 1e-5, 1e-9);
    for (const Complex root : polynomial_roots(std::vector<double>{1, 4, 6, 4, 1.0000001}))
        EXPECT_NEAR(std::abs(root + 1.0), std::pow(1e-7, 0.25), 1e-6);
}

}  // namespace
}  // namespace tunewright
