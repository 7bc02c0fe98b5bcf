// A plant's rational part as a fraction: the formula that it is evaluated by, for one frequency or for two at a time.
// `Number`: std::complex<double> or PairComplex.
#pragma once

#include "engine/numerics/fast_complex.h"
#include "engine/numerics/pair_complex.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

template <class Number>
struct FractionOf {
    Number numerator, denominator;
};

/// Of the plant without its dead time; finite for a finite s.
template <class Number>
FractionOf<Number> plant_fraction(const LinearPlant& plant, Number s) {
    FractionOf<Number> p{plant.gain(), 1.0};
    for (int i = 0; i < plant.integrators(); ++i) p.denominator = product(p.denominator, s);
    for (int i = 0; i < -plant.integrators(); ++i) p.numerator = product(p.numerator, s);
    for (const auto zero : plant.zeros()) p.numerator = product(p.numerator, s - zero);
    for (const auto pole : plant.poles()) p.denominator = product(p.denominator, s - pole);
    return p;
}

/// Calls `pair(omega, to)` for two neighbours at a time, and where it says false or there is only one, to[i] =
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
