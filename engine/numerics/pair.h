// Two neighbouring numbers of an array in one register, which every processor that we build for has: for short loops
// that a compiler leaves as they are. GCC's and Clang's vector extension.
//
//   for (std::size_t i = 0; i + 1 < n; i += 2) store(to + i, load(from + i) * 2.0);
#pragma once

#include <cstring>

namespace tunewright {

using Pair = double __attribute__((vector_size(16)));

/// The outcome of comparing two pairs: all bits where it holds, else none.
using PairMask = decltype(Pair{} < Pair{});

inline Pair load(const double* from) {
    Pair pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
}

inline void store(double* to, Pair pair) { std::memcpy(to, &pair, sizeof pair); }

inline Pair size(Pair x) { return x < 0 ? -x : x; }

inline Pair larger(Pair a, Pair b) { return a > b ? a : b; }

inline bool any(PairMask mask) { return (mask[0] | mask[1]) != 0; }

}  // namespace tunewright
