// The evaluation of a controller on a linear plant, or on the nominal one of several; also on a plant that is known by
// points of its frequency response, which has no responses over time. The figures of a nonlinear PID are here too.

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

/// The load IAE of evaluate_linear() alone, for a loop that is known to be stable.
Figure load_IAE(const LinearPlant& plant, const Controller& controller, const EvaluateOptions& options);

/// As evaluate(): every time-domain figure is empty.
Expected<Evaluation> evaluate_measured(const MeasuredPlant& plant, const Controller& controller,
                                       const EvaluateOptions& options);

/// For a nonlinear PID whose linear part gives a stable loop: does every error decay?
NonlinearFigures nonlinear_figures(const Loop& linear_part, double delta_r);

/// Adds the warning that frequency-domain figures are those of the linear part.
void warn_of_linear_part(Evaluation& evaluation);

/// Adds the same warning, and those on the dependence of responses on the step sizes, on a stalled integral and on
/// limits that are not applied.
void warn_of_nonlinearity(Evaluation& evaluation, const StepResponse& setpoint, const StepResponse& load,
                          const EvaluateOptions& options);

}  // namespace tunewright
