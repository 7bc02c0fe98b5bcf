// The default search: a coarse scan, the optimum of the integrated error as a start, then the true cost by quadratic
// programming.
#pragma once

#include <optional>

#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

/// What a search answers. Empty x never: without a feasible point the optional around it is empty.
struct Found {
    Point x{};
    double log_cost = 0;
    bool stopped = false;  ///< the report asked to stop: x is the best so far
};

/// Empty: no feasible controller was seen.
std::optional<Found> fast_search(const Sweep& sweep, const Problem& problem, const Report& report);

}  // namespace tunewright::robust
