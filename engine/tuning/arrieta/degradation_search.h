// Which Ms of the servo/regulation rule has a given degradation on a model.
#pragma once

#include <stop_token>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The smallest Ms from 1.4 to 2 with which Eq. 9 (c3 refitted) has this degradation (tradeoff.h) on the model, to
/// 1e-9. Errors: unsupported where no Ms has it (the sentence names the range) or the model has no optimum to measure
/// by; cancelled.
Expected<double> Ms_of_degradation(const Fopdt& model, double degradation, const std::stop_token& stop);

}  // namespace tunewright
