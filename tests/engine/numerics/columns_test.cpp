// Products of columns compared with plain sums, for lengths that fill registers and for others.
#include "engine/numerics/columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

using test::Random;
using Index = std::size_t;

constexpr double kRounding = 1e-13;

/// Columns of n random numbers, padded with zeros; one number in four is 0, as in a chain of lags.
std::vector<double> random_columns(Random& random, Index n, Index count) {
    std::vector<double> columns(count * column_length(n), 0.0);
    for (Index k = 0; k < count; ++k)
        for (Index i = 0; i < n; ++i)
            columns[k * column_length(n) + i] = random.uniform(0, 1) < 0.25 ? 0 : random.uniform(-1, 1);
    return columns;
}

/// Checks that each column has the n sums and zeros after them.
void expect_column(const double* column, const std::vector<double>& sums) {
    for (Index i = 0; i < column_length(sums.size()); ++i)
        EXPECT_NEAR(column[i], i < sums.size() ? sums[i] : 0, kRounding) << i << " of " << sums.size();
}

std::vector<Registers> all_registers() {
    if (widest_registers() == Registers::common) return {Registers::common};
    return {Registers::common, Registers::avx2};
}

class OfLength : public testing::TestWithParam<Index> {};

TEST_P(OfLength, AProductIsThatOfPlainSums) {
    const Index n = GetParam(), length = column_length(n), count = n + 3;
    Random random(n);
    const auto columns = random_columns(random, n, n), weights = random_columns(random, n, count);
    std::vector<std::vector<double>> products;
    for (const auto registers : all_registers()) {
        auto to = weights;  // in place
        multiply_columns({.columns = columns.data(),
                          .length = length,
                          .n = n,
                          .weights = to.data(),
                          .weights_apart = length,
                          .count = count,
                          .factor = 0.3,
                          .to = to.data(),
                          .to_apart = length},
                         registers);
        for (Index k = 0; k < count; ++k) {
            std::vector<double> sums(n, 0.0);
            for (Index j = 0; j < n; ++j)
                for (Index i = 0; i < n; ++i) sums[i] += 0.3 * columns[j * length + i] * weights[k * length + j];
            expect_column(to.data() + k * length, sums);
        }
        products.push_back(to);
    }
    EXPECT_EQ(products.front(), products.back()) << "the registers give different digits";
}

TEST_P(OfLength, AProductMayStandBesideItsWeights) {
    // Two more numbers in each column, behind the n that are used.
    const Index n = GetParam(), apart = column_length(n + 4);
    Random random(n + 50);
    const auto of_two = random_columns(random, 2, n), weights = random_columns(random, n + 4, 3);
    for (const auto registers : all_registers()) {
        auto both = weights;
        multiply_columns({.columns = of_two.data(),
                          .length = 4,
                          .n = n,
                          .weights = both.data(),
                          .weights_apart = apart,
                          .count = 3,
                          .to = both.data() + n,
                          .to_apart = apart},
                         registers);
        for (Index k = 0; k < 3; ++k) {
            std::vector<double> sums(2, 0.0);
            for (Index j = 0; j < n; ++j)
                for (Index i = 0; i < 2; ++i) sums[i] += of_two[4 * j + i] * weights[k * apart + j];
            expect_column(both.data() + k * apart + n, sums);
            for (Index i = 0; i < n; ++i) EXPECT_EQ(both[k * apart + i], weights[k * apart + i]);
        }
    }
}

/// Checks a map of z, whose first `n` numbers count.
void expect_map(Index n, Index size) {
    const Index length = column_length(size);
    Random random(n + 100 + size);
    const auto columns = random_columns(random, size, n + 5);
    const std::vector<double> inputs = {0.5, -2, 0, 3, 1};
    std::vector<double> z, sums(size, 0.0);
    for (Index i = 0; i < size; ++i) z.push_back(random.uniform(-1, 1));
    for (Index i = 0; i < size; ++i) {
        for (Index k = 0; k < n; ++k) sums[i] += columns[k * length + i] * z[k];
        for (Index k = 0; k < inputs.size(); ++k) sums[i] += columns[(n + k) * length + i] * inputs[k];
    }
    std::vector<std::vector<double>> mapped;
    for (const auto registers : all_registers()) {
        // Numbers next to z stay unchanged.
        std::vector<double> room(size + 8, 7.0);
        std::copy(z.begin(), z.end(), room.begin());
        map_columns(columns.data(), n, {room.data(), size}, inputs, registers);
        for (Index i = 0; i < size; ++i) EXPECT_NEAR(room[i], sums[i], kRounding) << i;
        for (Index i = size; i < room.size(); ++i) EXPECT_EQ(room[i], 7.0) << i - size << " beyond z";
        mapped.push_back(room);
    }
    EXPECT_EQ(mapped.front(), mapped.back()) << "the registers give different digits";
}

TEST_P(OfLength, AMapAddsWhatComesIn) { expect_map(GetParam(), GetParam()); }

TEST_P(OfLength, AMapMayGiveMoreThanItsOwnNumbers) { expect_map(GetParam(), GetParam() + 4); }

TEST_P(OfLength, AnAdditionTellsWhetherItCounted) {
    const Index n = GetParam();
    Random random(n + 200);
    const auto from = random_columns(random, n, 2);
    for (const auto registers : all_registers()) {
        auto to = random_columns(random, n, 2);
        const auto before = to;
        to[n - 1] = 1;
        auto small = std::vector<double>(from.size(), 0.0);
        small[n - 1] = 1;
        EXPECT_FALSE(add_columns(to.data(), small.data(), to.size(), 1e-20, registers));
        EXPECT_TRUE(add_columns(to.data(), small.data(), to.size(), -1e-15, registers)) << "of one number alone";
        to = before;
        EXPECT_TRUE(add_columns(to.data(), from.data(), to.size(), 2, registers));
        for (Index i = 0; i < to.size(); ++i) EXPECT_EQ(to[i], before[i] + 2 * from[i]) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Columns, OfLength, testing::Values(1, 2, 3, 4, 5, 7, 8, 9, 12, 13, 16, 17, 20, 21, 30));

}  // namespace
}  // namespace tunewright
