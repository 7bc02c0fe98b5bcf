// Sums over long vectors compared with plain sums; identical in both kinds of registers.
#include "engine/numerics/long_vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

std::vector<double> random_numbers(test::Random& random, std::size_t n) {
    std::vector<double> numbers(n);
    for (double& x : numbers) x = random.uniform(-1, 1);
    return numbers;
}

double plain_sum(const std::vector<double>& a, const std::vector<double>& b) {
    long double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<long double>(a[i]) * b[i];
    return static_cast<double>(sum);
}

// Lengths below one vectorised block, whole multiples of it, and with a remainder.
TEST(LongVectors, SumsAreThoseOfPlainOnesInBothRegisters) {
    test::Random random(1);
    for (const std::size_t n : {0, 1, 2, 5, 15, 16, 17, 31, 32, 33, 48, 63, 100, 1000, 4099}) {
        const auto a = random_numbers(random, n), b = random_numbers(random, n);
        const double rounding = 1e-15 * std::sqrt(static_cast<double>(n) + 1), weight = random.uniform(-2, 2);
        EXPECT_NEAR(sum_of_products(a, b), plain_sum(a, b), rounding) << n;
        EXPECT_EQ(sum_of_products(a, b), sum_of_products(a, b, Registers::common)) << n;

        std::vector<double> expected(n), to(n), common(n), in_place = a;
        for (std::size_t i = 0; i < n; ++i) expected[i] = a[i] + weight * b[i];
        const double square = add_multiple(a, weight, b, to);
        EXPECT_EQ(to, expected) << n;
        EXPECT_NEAR(square, plain_sum(expected, expected), 10 * rounding) << n;
        EXPECT_EQ(square, add_multiple(a, weight, b, common, Registers::common)) << n;
        EXPECT_EQ(common, to) << n;
        EXPECT_EQ(square, add_multiple(in_place, weight, b, in_place)) << n;
        EXPECT_EQ(in_place, to) << n;
    }
}

}  // namespace
}  // namespace tunewright
