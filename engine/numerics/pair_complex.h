// Two complex numbers at a time, for sweeps over frequency; pair.h has real ones. Formulas that are templates work with
// std::complex and with this type.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>

#include "engine/numerics/fast_complex.h"
#include "engine/numerics/pair.h"

namespace tunewright {

struct PairComplex {
    Pair re{}, im{};

    PairComplex() = default;
    PairComplex(double real) : re(Pair{} + real) {}
    PairComplex(Pair real, Pair imaginary) : re(real), im(imaginary) {}
};

inline PairComplex operator+(PairComplex a, PairComplex b) { return {a.re + b.re, a.im + b.im}; }
inline PairComplex operator-(PairComplex a, std::complex<double> b) { return {a.re - b.real(), a.im - b.imag()}; }
inline PairComplex operator*(double a, PairComplex b) { return {a * b.re, a * b.im}; }
inline PairComplex conj(PairComplex a) { return {a.re, -a.im}; }
inline Pair norm(PairComplex a) { return a.re * a.re + a.im * a.im; }

inline PairComplex product(PairComplex a, PairComplex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// n/d with `square` = |d|^2; both must be far from overflow and underflow.
inline PairComplex quotient(PairComplex n, PairComplex d, Pair square) {
    const PairComplex scaled = product(n, conj(d));
    return {scaled.re / square, scaled.im / square};
}

/// True if both squares are far enough from overflow and underflow.
inline bool ordinary(Pair square) {
    return square[0] > kMinSquare && square[0] < kMaxSquare && square[1] > kMinSquare && square[1] < kMaxSquare;
}

/// The largest angle for `unit_circle`, rad.
constexpr double kMaxPairAngle = 1e6;
inline bool in_reach(Pair angle) { return std::abs(angle[0]) <= kMaxPairAngle && std::abs(angle[1]) <= kMaxPairAngle; }

/// e^(j angle) to 2e-16 for |angle| <= kMaxPairAngle: by the remainder to the nearest multiple of pi/2, which has three
/// parts of 33 bits whose products with the multiple are exact (Cody and Waite, Software Manual for the Elementary
/// Functions, 1980), and the Taylor polynomials of sine and cosine up to pi/4.
inline PairComplex unit_circle(Pair angle) {
    constexpr double kRounder = 0x1.8p52;  // after adding it, the last bits hold the nearest whole number
    constexpr double kHalfPiFirst = 0x1.921fb544p0, kHalfPiSecond = 0x1.0b4611a6p-34,
                     kHalfPiThird = 0x1.3198a2e037073p-69;
    const Pair shifted = angle * (2 / std::numbers::pi) + kRounder, quarters = shifted - kRounder;
    const Pair r = ((angle - quarters * kHalfPiFirst) - quarters * kHalfPiSecond) - quarters * kHalfPiThird, s = r * r;
    Pair sine = s * (-1.0 / 1307674368000) + 1.0 / 6227020800;
    sine = sine * s - 1.0 / 39916800;
    sine = sine * s + 1.0 / 362880;
    sine = sine * s - 1.0 / 5040;
    sine = sine * s + 1.0 / 120;
    sine = sine * s - 1.0 / 6;
    sine = r + r * s * sine;
    Pair cosine = s * (1.0 / 20922789888000) - 1.0 / 87178291200;
    cosine = cosine * s + 1.0 / 479001600;
    cosine = cosine * s - 1.0 / 3628800;
    cosine = cosine * s + 1.0 / 40320;
    cosine = cosine * s - 1.0 / 720;
    cosine = cosine * s + 1.0 / 24;
    cosine = 1.0 - (0.5 * s - s * s * cosine);
    // Quarter turns: an odd number swaps sine and cosine, two change both signs.
    const PairBits quarter = bits_of(shifted), odd = (quarter & 1) != 0;
    const Pair re = odd ? sine : cosine, im = odd ? cosine : sine;
    return {((quarter + 1) & 2) != 0 ? -re : re, (quarter & 2) != 0 ? -im : im};
}

/// For one number or for two at a time.
template <class Number>
struct FractionOf {
    Number numerator, denominator;
};

/// Calls `pair(omega, to)` for two neighbours at a time; if it returns false, or for a single one, to[i] =
/// `one(omega)`.
template <class Value, class One, class TwoAtATime>
void in_pairs(std::span<const double> omega, Value* to, const One& one, const TwoAtATime& pair) {
    const std::size_t n = omega.size();
    for (std::size_t i = 0; i < n; i += 2) {
        if (i + 1 < n && pair(&omega[i], to + i)) continue;
        to[i] = one(omega[i]);
        if (i + 1 < n) to[i + 1] = one(omega[i + 1]);
    }
}

}  // namespace tunewright
