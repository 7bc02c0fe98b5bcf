// The evaluation of a controller on a nonlinear plant: the linearisation's, with the plant's own responses in place of
// the linear ones.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"

namespace tunewright {

/// As evaluate().
Expected<Evaluation> evaluate_nonlinear(const AnalysedNonlinear& subject, const Controller& controller,
                                        const EvaluateOptions& options);

/// The limits of the plant's input in place of the actuator's, where they are narrower.
EvaluateOptions limited_as(const NonlinearSystem& plant, EvaluateOptions options);

}  // namespace tunewright
