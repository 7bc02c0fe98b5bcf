// The complete search of a robust design: references, starts, repetitions, and the verification on an independent grid.
//
//  1. Search around the usual reference frequency, or from `before` alone (search.h).
//  2. Verify the result on an independent grid; tighten exceeded limits and search again.
//  3. If nothing was found, search around slower references, with the other sign of Kp, and around the least peak.
//  4. If the design lies beyond the scanned box, repeat around its own frequency while that improves it.
//  5. Compare a PID whose Td is at its lower end with a PI.

#pragma once

#include <optional>
#include <string>
#include <utility>

#include "engine/expected.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/robust.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

/// Start of the plane searches as (Ti, Td); empty: the best point of a scan.
using PlaneStart = std::optional<std::pair<double, double>>;

/// Searches, then verifies the result on the independent grid; if it exceeds a limit, the search is repeated with
/// tighter limits. `before`, if not null: a design of nearly the same problem (fewer plants, another limit), from which
/// alone the search starts; if it fails, the full search is made. A PID's ln Td is -infinity if a PI is better than any
/// derivative. `problem` receives the reference optima of a weighted objective, the sign of Kp, and the reference
/// frequency of the result: the usual one or another (slower_references()).
///
/// Errors: cancelled, unstable_plant, no_feasible_controller (with the smallest limit that
/// works), numerical_failure.
Expected<DesignResult> verified_search(SearchKind kind, DesignProblem& problem, const PlaneStart& start,
                                       CostSurface* surface, const RunControl& control, const DesignResult* before);

}  // namespace tunewright::robust
