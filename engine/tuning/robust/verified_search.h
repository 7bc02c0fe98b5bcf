// A robust design's search with everything around it: where to look, starts, second looks, and the check on a grid of
// its own.

#pragma once

#include <optional>
#include <string>
#include <utility>

#include "engine/expected.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/robust.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

/// Where the plane searches begin, as (Ti, Td); empty: at the best point of a scan.
using PlaneStart = std::optional<std::pair<double, double>>;

/// Searches, then holds the result against the independent grid; what exceeds a limit is searched again under tighter
/// ones. `before`, if not null: a design of nearly the same problem (fewer plants, another limit), from which alone it
/// is searched; where that finds nothing, the whole search is made. A PID's ln Td is -infinity where a PI does better
/// than any derivative. `problem` receives the reference optima of a weighted objective, the sign of Kp that was found
/// to work, and where the loop was found: about the usual reference or another (slower_references()).
///
/// Errors: cancelled, unstable_plant, no_feasible_controller (with the smallest limit that
/// works), numerical_failure.
Expected<DesignResult> verified_search(SearchKind kind, DesignProblem& problem, const PlaneStart& start,
                                       CostSurface* surface, const RunControl& control, const DesignResult* before);

}  // namespace tunewright::robust
