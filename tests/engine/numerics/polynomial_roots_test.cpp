// Multiple roots on one point, and simple ones left alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(MultipleRoots, NearOnesStayApart) {
    // Coefficients that tell 1 and 1.00001 apart, and four roots on a circle of radius 0.018 around -1.
    const auto two = polynomial_roots(std::vector<double>{1, 2.00001, 1.00001});
    EXPECT_NEAR(std::abs(two[0] - two[1]), 1e-5, 1e-9);
    for (const Complex root : polynomial_roots(std::vector<double>{1, 4, 6, 4, 1.0000001}))
        EXPECT_NEAR(std::abs(root + 1.0), std::pow(1e-7, 0.25), 1e-6);
}

}  // namespace
}  // namespace tunewright
