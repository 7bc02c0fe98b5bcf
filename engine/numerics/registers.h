// Wide registers, for loops without branches: their bodies are inlined into one function for each kind of register, and
// the processor at run time decides which one is called. Other compilers and processors use only the common registers.
//
//   TUNEWRIGHT_INLINED void body(...) { ... }
//   TUNEWRIGHT_FOR_AVX2 void body_avx2(...) { body(...); }
//   void loop(..., Registers registers = widest_registers()) {
//       registers == Registers::avx2 ? body_avx2(...) : body(...);
//   }
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TUNEWRIGHT_WIDE 1
#define TUNEWRIGHT_FOR_AVX2 [[gnu::target("avx2")]]
#else
#define TUNEWRIGHT_WIDE 0
#define TUNEWRIGHT_FOR_AVX2
#endif
#define TUNEWRIGHT_INLINED [[gnu::always_inline]] inline

namespace tunewright {

enum class Registers { common, avx2 };

/// act(0), ..., act(kCount - 1), each with a compile-time constant: a loop would keep values in memory that stay in
/// registers this way.
template <std::size_t kCount, class Act>
TUNEWRIGHT_INLINED void for_each_index(const Act& act) {
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
        (act(std::integral_constant<std::size_t, kIndex>()), ...);
    }
    (std::make_index_sequence<kCount>());
}

/// The widest registers of this processor.
inline Registers widest_registers() {
#if TUNEWRIGHT_WIDE
    static const bool wide = __builtin_cpu_supports("avx2");
    return wide ? Registers::avx2 : Registers::common;
#else
    return Registers::common;
#endif
}

}  // namespace tunewright
