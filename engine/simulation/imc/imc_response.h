// The response of a plant with the full revised IMC controller to constant set point and load from t = 0.
//
//   r --> (+) --> [ Q ] --> u --(+)--> [ P ] --> y        C = Q/(1 - G Q): the model runs in parallel, and Q sees
//          ^            |        ^ d          |           r - (y - y_m). Both dead times are exact.
//          |            +--> [ G ] --> y_m    |
//          +-------- y_m - y <----------------+
#pragma once

#include "engine/controller/imc_controller.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Between the times at which dead times bring kinks, steps are exact for a cubic through values and slopes of the
/// delayed signals (order 4); their lengths are proportional to the fourth root of the tolerance. The plant must be
/// stable and strictly proper, the loop stable, and the model's dead time > 0.
///
/// t is in the plant's time; y and r are in units of y, u and the load d in units of u, all as deviations.
/// - `y_final` is r, because the controller integrates; `u_final` is r/P(0) - d.
/// - `error_integral_final` is u_final kp d0 with C = 1/(kp d0 s) + ... at low frequency.
/// - `settles` is false if the response reaches neither the horizon nor rest within `max_steps` nodes.
/// - `options.repeat` and `options.tail` are not used, and `schedule` stays empty.
///
/// Source of the controller: Liu and Gao (2008), Eqs. 19-23 (imc_controller.h).
StepResponse simulate_imc(const LinearPlant& plant, const ImcController& controller, const StepInputs& inputs,
                          const ResponseOptions& options);

}  // namespace tunewright
