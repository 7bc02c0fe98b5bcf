// Where a descent may begin: the cheapest points of scans, by as few simulations as their bounds allow.
// Scans look coarsely over the (Ti, Td) plane: where a feasible, stable gain exists, and where the cost is low.

#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

struct ScanPoint {
    DesignPoint x{};
    double log_ie = 0;      ///< ln(Ti/|Kp|), a lower bound of ln(load IAE)
    bool verified = false;  ///< the loop is stable, not only by what the sweep's grid tells
};

/// How sure it must be that a loop is stable: by what the sweep's grid tells of the encirclements of -1, where it does;
/// or by an exact count.
enum class Stability { inferred, verified };

/// A gain at the end of a gap.
struct FeasibleGain {
    double Kp = 0;  ///< > 0: its magnitude
    bool verified = false;
};

/// The gains at the ends of the gaps (feasible, stable, largest first) for one (Ti, Td).
std::vector<FeasibleGain> feasible_gains(const Sweep& sweep, double Ti, double Td,
                                         Stability wanted = Stability::verified);

/// The points looked at, spaced evenly in logarithms; times in 1/reference frequency. The default box holds what
/// optimal designs of lag-dominant to dead-time-dominant plants use.
struct ScanBox {
    int Ti_points = 9, Td_points = 7;
    double Ti_low = 0.2, Ti_high = 60;
    double Td_low = 0.02, Td_high = 8;
};

/// The feasible points of the box with their largest gain, ascending in `log_ie`. Empty: no point of it is feasible.
/// Where stability is only told, whoever uses a point has it proved first: few of them are used. Points whose ln of the
/// cost is certainly not less than `below` are left out, most of them before their stability is asked for.
std::vector<ScanPoint> scan(const Sweep& sweep, const ScanBox& box = {}, Stability wanted = Stability::inferred,
                            double below = std::numeric_limits<double>::infinity());

/// The first point of the box with a stable loop; every gap of gains at a point is tried. `inferred`: only gaps that
/// the sweep's grid shows as stable; `verified`: also gaps that it leaves open, except narrow ones.
std::optional<DesignPoint> first_stable(const Sweep& sweep, const ScanBox& box, Stability wanted);

struct Candidate {
    DesignPoint x{};
    double log_cost = std::numeric_limits<double>::infinity();  ///< to a thousandth; infinite: no response settles
    bool stable = false;                                        ///< known to be
};

/// The cheapest of the least integrated error and the scan's points; empty if there is no design. `points` ascend in
/// `log_ie` and are not empty.
std::optional<Candidate> best_start(const Sweep& sweep, const DesignProblem& problem,
                                    const std::vector<ScanPoint>& points);

/// The cheapest point of each Td, cheapest first: four at most where the cost needs simulations. All ln Td up to
/// `short_Td` are one.
std::vector<Candidate> valley_starts(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                     double short_Td = -std::numeric_limits<double>::infinity());

/// The cheapest point whose ln of the cost is less than `below`; empty if there is none.
std::optional<Candidate> lowest_cost(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                     double below = std::numeric_limits<double>::infinity());

/// The cheapest design that a scan under wider limits leads to, moved inside the true ones, if ln of its cost is less
/// than `below`. Islands of high gain, which may be narrower than any scan's spacing, are wider under wider limits.
std::optional<Candidate> lowest_cost_island(const Sweep& sweep, const DesignProblem& problem, double below);

}  // namespace tunewright::robust
