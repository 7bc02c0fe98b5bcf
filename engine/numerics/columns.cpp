#include "engine/numerics/columns.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/numerics/pair.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kNegligible = 1e-18;  // of a number: well below rounding

// Blocks are passed only by reference: the calling convention for wide values depends on the processor.

template <class Block>
constexpr Index kWidth = sizeof(Block) / sizeof(double);

template <class Block, Index kBlocks>
using Column = std::array<Block, kBlocks>;

/// sum += the columns' combination with these weights, for columns of kBlocks blocks: this number of sums stays in
/// registers.
template <class Block, Index kBlocks>
TUNEWRIGHT_INLINED void combine(const double* columns, const double* weights, Index count,
                                Column<Block, kBlocks>& sum) {
    for (Index k = 0; k < count; ++k)
        for (Index i = 0; i < kBlocks; ++i) {
            Block part;
            std::memcpy(&part, columns + (k * kBlocks + i) * kWidth<Block>, sizeof part);
            sum[i] += part * weights[k];
        }
}

/// For columns of any length. Columns with weight 0 are skipped: in a chain of lags most of them are.
TUNEWRIGHT_INLINED void combine(const double* columns, const double* weights, Index count, Index length, double* sum) {
    for (Index k = 0; k < count; ++k) {
        if (weights[k] == 0) continue;
        for (Index i = 0; i < length; ++i) sum[i] += columns[k * length + i] * weights[k];
    }
}

template <class Block, Index kBlocks>
TUNEWRIGHT_INLINED void multiply(const ColumnProduct& p) {
    for (Index k = 0; k < p.count; ++k) {
        Column<Block, kBlocks> sum{};
        combine<Block, kBlocks>(p.columns, p.weights + k * p.weights_apart, p.n, sum);
        double* to = p.to + k * p.to_apart;
        for_each_index<kBlocks>([&](auto i) {
            sum[i] *= p.factor;
            std::memcpy(to + i * kWidth<Block>, &sum[i], sizeof(Block));
        });
    }
}

TUNEWRIGHT_INLINED void multiply_long(const ColumnProduct& p) {
    std::vector<double> sum(p.length);
    for (Index k = 0; k < p.count; ++k) {
        std::fill(sum.begin(), sum.end(), 0.0);
        combine(p.columns, p.weights + k * p.weights_apart, p.n, p.length, sum.data());
        for (Index i = 0; i < p.length; ++i) p.to[k * p.to_apart + i] = p.factor * sum[i];
    }
}

template <class Block>
TUNEWRIGHT_INLINED void multiply(const ColumnProduct& p) {
    constexpr Index kPerFour = 4 / kWidth<Block>;
    switch (p.length / 4) {
        case 1: return multiply<Block, kPerFour>(p);
        case 2: return multiply<Block, 2 * kPerFour>(p);
        case 3: return multiply<Block, 3 * kPerFour>(p);
        case 4: return multiply<Block, 4 * kPerFour>(p);
        case 5: return multiply<Block, 5 * kPerFour>(p);
        default: return multiply_long(p);
    }
}

template <class Block, Index kBlocks>
TUNEWRIGHT_INLINED void map(const double* columns, Index n, std::span<double> z, std::span<const double> inputs) {
    Column<Block, kBlocks> sum{}, inflow{};
    combine<Block, kBlocks>(columns, z.data(), n, sum);
    combine<Block, kBlocks>(columns + n * kBlocks * kWidth<Block>, inputs.data(), inputs.size(), inflow);
    // All but the last four numbers are full blocks; z may be shorter than those four.
    constexpr Index kFull = kBlocks * kWidth<Block> - 4;
    std::array<double, 4> last;
    for_each_index<kBlocks>([&](auto i) {
        constexpr Index at = i * kWidth<Block>;
        sum[i] += inflow[i];
        std::memcpy(at < kFull ? z.data() + at : last.data() + (at - kFull), &sum[i], sizeof(Block));
    });
    for (Index i = kFull; i < z.size(); ++i) z[i] = last[i - kFull];
}

TUNEWRIGHT_INLINED void map_long(const double* columns, Index n, std::span<double> z, std::span<const double> inputs) {
    const Index length = column_length(z.size());
    std::vector<double> sum(length);
    combine(columns, z.data(), n, length, sum.data());
    combine(columns + n * length, inputs.data(), inputs.size(), length, sum.data());
    std::copy_n(sum.begin(), z.size(), z.begin());
}

template <class Block>
TUNEWRIGHT_INLINED void map(const double* columns, Index n, std::span<double> z, std::span<const double> inputs) {
    constexpr Index kPerFour = 4 / kWidth<Block>;
    switch (column_length(z.size()) / 4) {
        case 1: return map<Block, kPerFour>(columns, n, z, inputs);
        case 2: return map<Block, 2 * kPerFour>(columns, n, z, inputs);
        case 3: return map<Block, 3 * kPerFour>(columns, n, z, inputs);
        case 4: return map<Block, 4 * kPerFour>(columns, n, z, inputs);
        case 5: return map<Block, 5 * kPerFour>(columns, n, z, inputs);
        default: return map_long(columns, n, z, inputs);
    }
}

template <class Block>
TUNEWRIGHT_INLINED void without_sign(Block& x) {
    using Bits = decltype(x < x);
    Bits bits;
    std::memcpy(&bits, &x, sizeof bits);
    bits &= std::int64_t{0x7fffffffffffffff};
    std::memcpy(&x, &bits, sizeof x);
}

template <class Block>
TUNEWRIGHT_INLINED bool add(double* to, const double* from, Index count, double weight) {
    decltype(Block{} < Block{}) counting{};
    for (Index i = 0; i < count; i += kWidth<Block>) {
        Block sum, term;
        std::memcpy(&sum, to + i, sizeof sum);
        std::memcpy(&term, from + i, sizeof term);
        term *= weight;
        sum += term;
        std::memcpy(to + i, &sum, sizeof sum);
        without_sign(term);
        without_sign(sum);
        counting |= term > kNegligible * sum;
    }
    std::int64_t any = 0;
    for (Index i = 0; i < kWidth<Block>; ++i) any |= counting[i];
    return any != 0;
}

TUNEWRIGHT_FOR_AVX2 void multiply_avx2(const ColumnProduct& product) { multiply<Quad>(product); }

TUNEWRIGHT_FOR_AVX2 void map_avx2(const double* columns, Index n, std::span<double> z, std::span<const double> inputs) {
    map<Quad>(columns, n, z, inputs);
}

TUNEWRIGHT_FOR_AVX2 bool add_avx2(double* to, const double* from, Index count, double weight) {
    return add<Quad>(to, from, count, weight);
}

}  // namespace

void multiply_columns(const ColumnProduct& product, Registers registers) {
    if (registers == Registers::avx2) return multiply_avx2(product);
    multiply<Pair>(product);
}

void map_columns(const double* columns, Index n, std::span<double> z, std::span<const double> inputs,
                 Registers registers) {
    if (registers == Registers::avx2) return map_avx2(columns, n, z, inputs);
    map<Pair>(columns, n, z, inputs);
}

bool add_columns(double* to, const double* from, Index count, double weight, Registers registers) {
    if (registers == Registers::avx2) return add_avx2(to, from, count, weight);
    return add<Pair>(to, from, count, weight);
}

}  // namespace tunewright
