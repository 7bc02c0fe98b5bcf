// What the evaluation says of a nonlinear PID beyond its linear part.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/loop/loop.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Of a loop whose linear part is stable: does every error die out?
NonlinearFigures nonlinear_figures(const Loop& linear_part, double delta_r);

/// Adds that figures over frequency are the linear part's.
void warn_of_linear_part(Evaluation& evaluation);

/// Adds the same, how the responses depend on the step sizes, where the integral stalls and what is not applied.
void warn_of_nonlinearity(Evaluation& evaluation, const StepResponse& setpoint, const StepResponse& load,
                          const EvaluateOptions& options);

}  // namespace tunewright
