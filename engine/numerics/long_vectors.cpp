#include "engine/numerics/long_vectors.h"

#include <array>
#include <cstddef>
#include <cstring>

#include "engine/numerics/pair.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr Index kAtOnce = 16;  // number of sums side by side, so that an addition need not wait for the previous one

/// Number i of a vector is added to sum i modulo kAtOnce, for any block size.
template <class Block>
using Sums = std::array<Block, kAtOnce * sizeof(double) / sizeof(Block)>;

template <class Block>
TUNEWRIGHT_INLINED void load_block(const double* from, Block& block) {
    std::memcpy(&block, from, sizeof block);
}

/// The total of the blocks' sums and of the numbers after the last full block.
template <class Block, class Product>
TUNEWRIGHT_INLINED double total(const Sums<Block>& sums, Index from, Index n, const Product& product) {
    std::array<double, kAtOnce> sum;
    std::memcpy(sum.data(), sums.data(), sizeof sum);
    for (Index i = from; i < n; ++i) sum[i - from] += product(i);
    for (Index half = kAtOnce / 2; half > 0; half /= 2)
        for (Index i = 0; i < half; ++i) sum[i] += sum[i + half];
    return sum[0];
}

template <class Block>
TUNEWRIGHT_INLINED double products(const double* a, const double* b, Index n) {
    constexpr Index kWidth = sizeof(Block) / sizeof(double);
    Sums<Block> sums{};
    Index at = 0;
    for (; at + kAtOnce <= n; at += kAtOnce)
        for (Index k = 0; k < sums.size(); ++k) {
            Block x, y;
            load_block(a + at + k * kWidth, x);
            load_block(b + at + k * kWidth, y);
            sums[k] += x * y;
        }
    return total<Block>(sums, at, n, [=](Index i) { return a[i] * b[i]; });
}

template <class Block>
TUNEWRIGHT_INLINED double multiple(const double* x, double weight, const double* y, double* to, Index n) {
    constexpr Index kWidth = sizeof(Block) / sizeof(double);
    Sums<Block> sums{};
    Index at = 0;
    for (; at + kAtOnce <= n; at += kAtOnce)
        for (Index k = 0; k < sums.size(); ++k) {
            Block sum, part;
            load_block(x + at + k * kWidth, sum);
            load_block(y + at + k * kWidth, part);
            sum += weight * part;
            std::memcpy(to + at + k * kWidth, &sum, sizeof sum);
            sums[k] += sum * sum;
        }
    return total<Block>(sums, at, n, [=](Index i) {
        to[i] = x[i] + weight * y[i];
        return to[i] * to[i];
    });
}

TUNEWRIGHT_FOR_AVX2 double products_avx2(const double* a, const double* b, Index n) { return products<Quad>(a, b, n); }

TUNEWRIGHT_FOR_AVX2 double multiple_avx2(const double* x, double weight, const double* y, double* to, Index n) {
    return multiple<Quad>(x, weight, y, to, n);
}

}  // namespace

double sum_of_products(std::span<const double> a, std::span<const double> b, Registers registers) {
    if (registers == Registers::avx2) return products_avx2(a.data(), b.data(), a.size());
    return products<Pair>(a.data(), b.data(), a.size());
}

double add_multiple(std::span<const double> x, double weight, std::span<const double> y, std::span<double> to,
                    Registers registers) {
    if (registers == Registers::avx2) return multiple_avx2(x.data(), weight, y.data(), to.data(), x.size());
    return multiple<Pair>(x.data(), weight, y.data(), to.data(), x.size());
}

}  // namespace tunewright
