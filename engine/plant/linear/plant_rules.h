// What a linear plant must keep before anything can be computed with it.
#pragma once

#include <vector>

#include "engine/error.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// Complex zeros and poles count as conjugates where they differ by no more than this, relative: roots that a program
/// has computed differ in their last digits.
constexpr double kConjugateTolerance = 1e-9;

/// Every fault at once, invalid_argument with `where` = "plant/<field>": numbers that are not finite, K = 0, L < 0, T
/// <= 0 beside zeta, ranges of uncertainty that leave the nominal value out, empty or zero num or den, more zeros than
/// poles, complex values without a conjugate, shapes of A, B, C.
std::vector<Error> plant_faults(const Plant& plant);

}  // namespace tunewright
