// Where a descent may begin: the cheapest points of scans, by as few simulations as their bounds allow.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {

struct Candidate {
    DesignPoint x{};
    double log_cost = std::numeric_limits<double>::infinity();  ///< to a thousandth; infinite: no response settles
};

/// The cheapest of the least integrated error and the scan's points; empty if there is no design. `points` ascend in
/// `log_ie` and are not empty.
std::optional<Candidate> best_start(const Sweep& sweep, const DesignProblem& problem,
                                    const std::vector<ScanPoint>& points);

/// The cheapest point of each Td, cheapest first: four at most where the cost needs simulations.
std::vector<Candidate> valley_starts(const DesignProblem& problem, const std::vector<ScanPoint>& points);

/// The cheapest point whose ln of the cost is less than `below`; empty if there is none.
std::optional<Candidate> cheapest(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                  double below = std::numeric_limits<double>::infinity());

/// The cheapest design that a scan under wider limits leads to, moved inside the true ones, if ln of its cost is less
/// than `below`. Islands of high gain, which may be narrower than any scan's spacing, are wider under wider limits.
std::optional<Candidate> cheapest_island(const Sweep& sweep, const DesignProblem& problem, double below);

}  // namespace tunewright::robust
