// A plant's rational part as a fraction: the formula with which it is evaluated, for one frequency or for two at a
// time. `Number`: std::complex<double> or PairComplex.
#pragma once

#include <cmath>
#include <complex>

#include "engine/numerics/fast_complex.h"
#include "engine/numerics/pair_complex.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// For the plant without its dead time; finite for a finite s.
template <class Number>
FractionOf<Number> plant_fraction(const LinearPlant& plant, Number s) {
    FractionOf<Number> p{plant.gain(), 1.0};
    for (int i = 0; i < plant.integrators(); ++i) p.denominator = product(p.denominator, s);
    for (int i = 0; i < -plant.integrators(); ++i) p.numerator = product(p.numerator, s);
    for (const auto zero : plant.zeros()) p.numerator = product(p.numerator, s - zero);
    for (const auto pole : plant.poles()) p.denominator = product(p.denominator, s - pole);
    return p;
}

/// e^(-s L) of the plant's dead time L.
inline std::complex<double> delay_of(const LinearPlant& plant, std::complex<double> s) {
    const double L = plant.dead_time(), angle = -s.imag() * L;
    const std::complex<double> turned(std::cos(angle), std::sin(angle));
    return s.real() == 0 ? turned : turned * std::exp(-s.real() * L);
}

}  // namespace tunewright
