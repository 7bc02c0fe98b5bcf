// The start of every evaluation: the checks that come first, and the remarks that do not depend on the kind of plant.
#pragma once

#include <optional>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/loop/stability.h"

namespace tunewright {

/// The first error of the options ("evaluate/...") or of an Npid ("controller/..."), for any plant.
std::optional<Error> refuse_evaluation(const Controller& controller, const EvaluateOptions& options);

/// An error if the traces of this number of controllers would have too many points in one answer.
std::optional<Error> refuse_traces(const EvaluateOptions& options, std::size_t controllers);

/// An error if the options' stop was requested.
std::optional<Error> stopped(const EvaluateOptions& options);

/// The same controller; an Npid without delta_r has the size of the set-point step for it, a SeriesPid its
/// b_equivalent.
Controller resolved(Controller controller, const EvaluateOptions& options);

/// Starts an evaluation: the resolved controller with its equivalents.
Evaluation begun(const Controller& controller, const EvaluateOptions& options);

/// The error of a loop that cannot be formed; if its `where` is empty it names the controller.
Error of_controller(Error error);

/// Sets an unstable loop's figures and warning.
void mark_unstable(Evaluation& evaluation, const StabilityCount& count);

/// Adds that u reaches a limit after the `step` ("set-point" or "load") step.
void warn_of_limit(Evaluation& evaluation, const std::string& step);

/// Adds that a response does not settle within the simulated time.
void warn_of_no_rest(Evaluation& evaluation);

}  // namespace tunewright
