// The default search: a coarse scan, the optimum of the integrated error as a start, then the true cost by quadratic
// programming; from further starts where there may be more than one valley.
#pragma once

#include <optional>

#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

/// Empty: no feasible controller was seen.
std::optional<Found> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report);

}  // namespace tunewright::robust
