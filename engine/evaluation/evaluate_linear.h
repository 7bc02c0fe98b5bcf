// The evaluation of a controller on a linear plant, or on the nominal one of several; and on a plant that is known by
// points of its frequency response, which has no responses over time.

#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/frequency_response.h"
#include "engine/plant/subject.h"

namespace tunewright {

/// As evaluate().
Expected<Evaluation> evaluate_linear(const LinearSubject& subject, const Controller& controller,
                                     const EvaluateOptions& options);

/// As evaluate(): everything in time is empty.
Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options);

}  // namespace tunewright
