// What every evaluation begins with: the checks that come first, and the remarks that do not depend on the kind of
// plant.
#pragma once

#include <optional>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/loop/stability.h"

namespace tunewright {

/// The first fault of the options ("evaluate/...") or of an Npid ("controller/..."), whatever the plant.
std::optional<Error> refuse_evaluation(const Controller& controller, const EvaluateOptions& options);

/// An error where the traces of so many controllers in one answer would have too many points altogether.
std::optional<Error> refuse_traces(const EvaluateOptions& options, std::size_t controllers);

/// An error where the options' stop was requested.
std::optional<Error> stopped(const EvaluateOptions& options);

/// The same controller; an Npid without delta_r has the set-point step's size for it, a SeriesPid its b_equivalent.
Controller resolved(Controller controller, const EvaluateOptions& options);

/// The controller, resolved, with its equivalents.
Evaluation begun(const Controller& controller, const EvaluateOptions& options);

/// An error of a loop that cannot be formed, placed at the controller where it has no place.
Error of_controller(Error error);

/// An unstable loop's figures and warning.
void mark_unstable(Evaluation& evaluation, const StabilityCount& count);

/// Adds that u reaches a limit after the `step` ("set-point" or "load") step.
void warn_of_limit(Evaluation& evaluation, const std::string& step);

/// Adds that a response does not come to rest within the time computed.
void warn_of_no_rest(Evaluation& evaluation);

}  // namespace tunewright
