// Converts a linear plant from the user's form to gain, zeros, poles and integrators, and checks its numbers.
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

/// Relative difference within which complex zeros and poles count as conjugates: computed roots differ in their last
/// digits.
constexpr double kConjugateTolerance = 1e-9;

/// All errors at once, invalid_argument with `where` = "plant/<field>": numbers that are not finite, K = 0, L < 0, T <=
/// 0 together with zeta, ranges of uncertainty without the nominal value, empty or zero num or den, more zeros than
/// poles, complex values without a conjugate, shapes of A, B, C.
std::vector<Error> plant_faults(const Plant& plant);

}  // namespace tunewright
