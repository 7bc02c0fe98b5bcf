// The response that the nonlinear controller is to give: as asked for, or from the linearisation.
#pragma once

#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/nonlinear/linearising_response.h"
#include "engine/tuning/emulation/options.h"

namespace tunewright::emulation {

/// By the option `target`. Errors: invalid_argument, `where` = "target/...", where it does not suit the relative
/// degree, which the sentence names, or is not stable.
Expected<TargetResponse> chosen_target(const LinearPlant& plant, int relative_degree, const TargetOptions& options);

/// beta_1: the lags' sum, the area under 1 - y of a unit step.
double target_time(const TargetResponse& target);

/// 1/|Re p| of the slowest pole of the target.
double slowest_time(const TargetResponse& target);

/// 1/|p| of the slowest pole p != 0 of a plant; without one ten dead times, or 1.
double plant_time(const LinearPlant& plant);

}  // namespace tunewright::emulation
