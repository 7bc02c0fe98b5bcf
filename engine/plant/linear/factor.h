// From a linear plant as the user describes it to gain, zeros, poles and integrators, and what its numbers must keep
// before that.
#pragma once

#include <complex>
#include <vector>

#include "engine/error.h"
#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// gain s^(-integrators) prod(s - z)/prod(s - p); no zero or pole at the origin is left in the lists.
struct Factors {
    double gain = 0;
    int integrators = 0;
    std::vector<std::complex<double>> zeros, poles;
};

/// Checks every number of the plant and factors it. Errors: as LinearPlant::make.
Expected<Factors> factor(const Plant& plant);

/// Complex zeros and poles count as conjugates where they differ by no more than this, relative: roots that a program
/// has computed differ in their last digits.
constexpr double kConjugateTolerance = 1e-9;

/// Every fault at once, invalid_argument with `where` = "plant/<field>": numbers that are not finite, K = 0, L < 0, T
/// <= 0 beside zeta, ranges of uncertainty that leave the nominal value out, empty or zero num or den, more zeros than
/// poles, complex values without a conjugate, shapes of A, B, C.
std::vector<Error> plant_faults(const Plant& plant);

}  // namespace tunewright
