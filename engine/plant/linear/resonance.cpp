#include "engine/plant/linear/resonance.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace tunewright {
namespace {

constexpr double kResonantDamping = 0.4;

}  // namespace

bool is_resonant(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return pole.imag() > 0 && std::abs(pole.real()) < kResonantDamping * std::abs(pole);
    });
}

}  // namespace tunewright
