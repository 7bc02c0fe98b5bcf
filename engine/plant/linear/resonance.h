// The test for a plant with an oscillation of its own.
//
//   if (is_resonant(plant)) ...   // look for further local minima
//
// A resonance gives a search for the best controller several local minima: a quick loop whose derivative damps the
// resonance, a slow one whose gain stays below it, and integral action alone with a filter that removes it. Without one
// a search from a single good start finds the best design of nearly all plants (bench/robust_search compares
// thousands).
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// Damping of a pair of poles below which the plant counts as resonant: its own oscillation then lasts for two periods
/// and more.
inline constexpr double kResonantDamping = 0.4;

/// True if a pair of poles is damped less than that. Real poles, also unstable ones, and integrators do not count; a
/// growing oscillation with so little real part does.
inline bool is_resonant(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return pole.imag() > 0 && std::abs(pole.real()) < kResonantDamping * std::abs(pole);
    });
}

}  // namespace tunewright
