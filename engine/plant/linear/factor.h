// From a plant as described by the user to gain, zeros, poles, integrators.
#pragma once

#include <complex>
#include <vector>

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

}  // namespace tunewright
