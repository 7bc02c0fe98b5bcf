// The robust design of a controller as it is built: limits on the loop as it computes, settings as they are typed.
#pragma once

#include "engine/tuning/built/build.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright {

/// As the method robust, on the controller's own law. Its objective is the load IAE, whatever the options say; a
/// warning says so. `ideal`: the method on the ideal law, for the start. Errors: those of the method and of
/// built::design.
Expected<BuiltDesign> tune_robust_as_built(const TuningProblem& tuning, const RobustOptions& options,
                                           const built::Build& build, const RunControl& control);

}  // namespace tunewright
