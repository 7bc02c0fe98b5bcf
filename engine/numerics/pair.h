// Two neighbouring numbers of an array in one register: for short loops that a compiler does not vectorise. Uses the
// vector extension of GCC and Clang; every supported processor has such registers.
//
//   for (std::size_t i = 0; i + 1 < n; i += 2) store(to + i, load(from + i) * 2.0);
#pragma once

#include <cstdint>
#include <cstring>

namespace tunewright {

using Pair = double __attribute__((vector_size(16)));

/// Four numbers, in loops that also exist for wider registers (registers.h).
using Quad = double __attribute__((vector_size(32)));

/// The result of comparing two pairs: all bits set where the comparison holds, else none.
using PairMask = decltype(Pair{} < Pair{});

inline Pair load(const double* from) {
    Pair pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
}

inline void store(double* to, Pair pair) { std::memcpy(to, &pair, sizeof pair); }

using PairBits = std::int64_t __attribute__((vector_size(16)));

inline PairBits bits_of(Pair x) {
    PairBits bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

/// |x|: clears the sign bits.
inline Pair size(Pair x) {
    const PairBits bits = bits_of(x) & std::int64_t{0x7fffffffffffffff};
    std::memcpy(&x, &bits, sizeof bits);
    return x;
}

inline bool any(PairMask mask) { return (mask[0] | mask[1]) != 0; }

}  // namespace tunewright
