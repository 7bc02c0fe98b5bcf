// A robust design's search with everything around it: starts, second looks, the check on a grid of its own, and the
// sentence where there is no answer: how far from feasible the plant is, and whether the optimum has no end.

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

/// The common limit on Ms and Mt that the sentence of a no_feasible_controller names as its cure; empty where it names
/// none. Read back from the sentence, which is all that an error carries.
std::optional<double> named_limit(const Error& error);

/// Searches, then holds the result against the independent grid; what exceeds a limit is searched again under tighter
/// ones. `before`, if not null: a design of nearly the same problem (fewer plants, another limit), from which alone it
/// is searched; where that finds nothing, the whole search is made. A PID's ln Td is -infinity where a PI does better
/// than any derivative. `problem` receives the reference optima of a weighted objective, the sign of Kp that was found
/// to work, and where the loop was found if that is not the usual reference (slower_references()).
///
/// Errors: cancelled, unstable_plant, no_feasible_controller (with the smallest limit that
/// works), numerical_failure.
Expected<Found> verified_search(SearchKind kind, DesignProblem& problem, const PlaneStart& start, CostSurface* surface,
                                const RunControl& control, const Found* before);

/// The controller whose larger peak of |S| and |T| is smallest.
struct LeastPeak {
    double M = 0;  ///< that peak, to about 0.1 %
    DesignPoint x{};
};

/// Empty if no controller was found that stabilises the plant. Limits play no part, the filter rule does.
std::optional<LeastPeak> least_common_peak(const DesignProblem& problem);

/// True where the gain is unbounded within the limits: no dead time, no right-half-plane zero, and a design of the
/// plant's high-frequency asymptote that scales with frequency exists (Tf tied to Td, no filter, or a filter that
/// leaves a pole excess of one).
bool has_no_finite_optimum(const DesignProblem& problem);

}  // namespace tunewright::robust
