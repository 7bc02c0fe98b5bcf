// A linear plant written as differential equations, for what works on nonlinear plants.
#pragma once

#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// x1, x2, ... of the plant's realisation, with operating point, input u and output 0, and the plant's dead time.
/// Errors: unsupported for a plant with a direct term from u to y, or of more than 20 states.
Expected<NonlinearSystem> as_equations(const LinearPlant& plant);

}  // namespace tunewright
