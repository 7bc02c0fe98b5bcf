// The response of a plant under the full revised IMC controller to constant set point and load from t = 0.
//
//   r --> (+) --> [ Q ] --> u --(+)--> [ P ] --> y        C = Q/(1 - G Q): the model runs beside the plant, and Q sees
//          ^            |        ^ d          |           r - (y - y_m). Both dead times are exact.
//          |            +--> [ G ] --> y_m    |
//          +-------- y_m - y <----------------+
#pragma once

#include "engine/controller/imc_controller.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Between the instants at which dead times bring kinks, steps are exact for a cubic through values and slopes of what
/// comes delayed (order 4); their lengths go with the fourth root of the tolerance. The plant is stable and strictly
/// proper, the loop stable, the model's dead time > 0.
StepResponse simulate_imc(const LinearPlant& plant, const ImcController& controller, const StepInputs& inputs,
                          const ResponseOptions& options);

}  // namespace tunewright
