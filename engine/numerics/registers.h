// Registers wider than those that every processor has, for loops in straight lines: their bodies are inlined into a
// function for each kind of register, and the processor that runs the program decides which one is called. Other
// compilers and processors get the common one alone.
//
//   TUNEWRIGHT_INLINED void body(...) { ... }
//   TUNEWRIGHT_FOR_AVX2 void body_avx2(...) { body(...); }
//   void loop(..., Registers registers = widest_registers()) {
//       registers == Registers::avx2 ? body_avx2(...) : body(...);
//   }
#pragma once

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

/// The widest that this processor has.
inline Registers widest_registers() {
#if TUNEWRIGHT_WIDE
    static const bool wide = __builtin_cpu_supports("avx2");
    return wide ? Registers::avx2 : Registers::common;
#else
    return Registers::common;
#endif
}

}  // namespace tunewright
