// The evaluation of a controller on a linear plant, or on the nominal one of several; and on a plant that is known by
// points of its frequency response, which has no responses over time. What a nonlinear PID adds to its linear part is
// here too.

#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/loop/loop.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/frequency_response.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// As evaluate().
Expected<Evaluation> evaluate_linear(const AnalysedLinear& subject, const Controller& controller,
                                     const EvaluateOptions& options);

/// As evaluate(): everything in time is empty.
Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options);

/// Of a nonlinear PID in a loop whose linear part is stable: does every error die out?
NonlinearFigures nonlinear_figures(const Loop& linear_part, double delta_r);

/// Adds the warning that figures over frequency are the linear part's.
void warn_of_linear_part(Evaluation& evaluation);

/// Adds the same warning, and those on how the responses depend on the step sizes, where the integral stalls and what
/// is not applied.
void warn_of_nonlinearity(Evaluation& evaluation, const StepResponse& setpoint, const StepResponse& load,
                          const EvaluateOptions& options);

}  // namespace tunewright
