// The evaluation of one controller on one plant.
#pragma once

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"

namespace tunewright {

/// Errors: invalid_argument for a plant or controller that cannot form a loop (where: "plant/...", "controller/...",
/// "evaluate/..."). An unstable loop is no error: `stable` is false, figures are empty, and a warning says so.
/// - For an Npid the responses are those of the nonlinear loop and hold for these step sizes; `robustness`,
///   `frequency`, `region` and noise belong to its linear part, and actuator limits are not applied. An empty delta_r
///   is filled in.
/// - All figures are the nominal plant's; `region` has those of the other plants.
/// - For a frequency response every time-domain figure is empty; unsupported if its band ends too early to evaluate the
///   loop.
/// - For a nonlinear plant performance and responses are its own, for these step sizes, within its input's limits;
///   frequency-domain and noise figures belong to its linearisation. If the linearised loop is unstable, the responses
///   are simulated all the same.
Expected<Evaluation> evaluate(const AnalysedPlant& subject, const Controller& controller,
                              const EvaluateOptions& options);

/// The same for a plant that has not been analysed; its first error is returned.
Expected<Evaluation> evaluate(const PlantModel& plant, const Controller& controller, const EvaluateOptions& options);

/// The error if the controller cannot form a loop with the plant, or with one of several: `where` = "controller/...".
std::optional<Error> loop_fault(const AnalysedPlant& subject, const Controller& controller);

/// The options for the plant's linearisation: the limits of its input become the actuator's. For other plants the same
/// options.
EvaluateOptions on_linearisation(const AnalysedPlant& subject, EvaluateOptions options);

}  // namespace tunewright
