// The evaluation of one controller on one plant.
#pragma once

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"

namespace tunewright {

/// Errors: invalid_argument for a plant or controller that cannot form a loop (where: "plant/...", "controller/...",
/// "evaluate/..."). An unstable loop is no error: `stable` is false, figures are empty, and a warning says so.
/// Of an Npid the responses are the nonlinear loop's and hold for these step sizes; `robustness`, `frequency`, `region`
/// and noise belong to its linear part, and actuator limits are not applied. Its delta_r is filled in.
/// All figures are the nominal plant's; `region` says how the others fare. Of a frequency response everything in time
/// is empty; unsupported where its band ends too early to judge the loop.
/// Of a nonlinear plant performance and responses are its own, for these step sizes, within its input's limits; figures
/// over frequency and noise belong to its linearisation. Where the linearised loop is unstable, responses show what
/// happens all the same.
Expected<Evaluation> evaluate(const AnalysedPlant& subject, const Controller& controller,
                              const EvaluateOptions& options);

/// The same of a plant that has not been looked at; the first of its faults is the error.
Expected<Evaluation> evaluate(const PlantModel& plant, const Controller& controller, const EvaluateOptions& options);

/// What keeps the controller from forming a loop with the plant, or with one of several: `where` = "controller/...".
std::optional<Error> loop_fault(const AnalysedPlant& subject, const Controller& controller);

/// The options for the plant's linearisation, on which the limits of its input are the actuator's; of other plants the
/// same options.
EvaluateOptions on_linearisation(const AnalysedPlant& subject, EvaluateOptions options);

}  // namespace tunewright
