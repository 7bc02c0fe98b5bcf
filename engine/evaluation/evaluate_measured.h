// The evaluation of a controller on a plant that is known by points of its frequency response.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/frequency_response.h"

namespace tunewright {

/// As evaluate(): everything in time is empty.
Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options);

}  // namespace tunewright
