// A nonlinear plant as linear methods see it.
#pragma once

#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// The linearisation about the steady state. Errors, in words of the equations: the input cannot move the output there,
/// with the reason that the relative degree gives; as LinearPlant::make, `where` = "plant/equations".
Expected<LinearPlant> linearised_plant(const NonlinearSystem& system);

}  // namespace tunewright
