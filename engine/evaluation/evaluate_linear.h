// The evaluation of a controller on a linear plant, or on the nominal one of several.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/subject.h"

namespace tunewright {

/// As evaluate().
Expected<Evaluation> evaluate_linear(const LinearSubject& subject, const Controller& controller,
                                     const EvaluateOptions& options);

}  // namespace tunewright
