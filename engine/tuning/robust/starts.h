// Starts of a descent: the cheapest points of scans, found with as few simulations as the bounds of their costs allow.
// Scans search the (Ti, Td) plane coarsely for feasible, stable gains and a low cost.

#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

struct ScanPoint {
    DesignPoint x{};
    double log_ie = 0;      ///< ln(Ti/|Kp|), a lower bound of ln(load IAE)
    bool verified = false;  ///< true: the loop's stability is verified, not only inferred from the sweep's grid
};

/// Knowledge of a loop's stability: inferred from the encirclements of -1 on the sweep's grid, if it shows them; or
/// verified by an exact count.
enum class Stability { inferred, verified };

/// A gain at the end of a gap.
struct FeasibleGain {
    double Kp = 0;  ///< > 0: its magnitude
    bool verified = false;
};

/// The gains at the ends of the gaps (feasible, stable, largest first) for one (Ti, Td).
std::vector<FeasibleGain> feasible_gains(const Sweep& sweep, double Ti, double Td,
                                         Stability wanted = Stability::verified);

/// The points of a scan, spaced evenly in logarithms; times in 1/reference frequency. The default box contains the
/// optimal designs of lag-dominant to dead-time-dominant plants.
struct ScanBox {
    int Ti_points = 9, Td_points = 7;
    double Ti_low = 0.2, Ti_high = 60;
    double Td_low = 0.02, Td_high = 8;
};

/// The feasible points of the box with their largest gain, ascending in `log_ie`. Empty: no point of it is feasible. If
/// stability is only inferred, the caller must verify it before using a point: only few points are used. Points whose
/// ln of the cost is certainly not below `below` are omitted, most of them before their stability is checked.
std::vector<ScanPoint> scan(const Sweep& sweep, const ScanBox& box = {}, Stability wanted = Stability::inferred,
                            double below = std::numeric_limits<double>::infinity());

/// The first point of the box with a stable loop; every gap of gains at a point is tried. `inferred`: only gaps that
/// the sweep's grid shows as stable; `verified`: also gaps that it leaves open, except narrow ones.
std::optional<DesignPoint> first_stable(const Sweep& sweep, const ScanBox& box, Stability wanted);

struct Candidate {
    DesignPoint x{};
    double log_cost = std::numeric_limits<double>::infinity();  ///< with an error of 1e-3; infinite: no response
                                                                ///< settles
    bool stable = false;                                        ///< true: known to be stable
};

/// The cheapest of the scan's points and the design with the least integrated error; empty if there is no design.
/// `points` are in ascending order of `log_ie` and not empty.
std::optional<Candidate> best_start(const Sweep& sweep, const DesignProblem& problem,
                                    const std::vector<ScanPoint>& points);

/// The cheapest point of each Td, cheapest first: four at most where the cost needs simulations. All ln Td up to
/// `short_Td` count as equal.
std::vector<Candidate> valley_starts(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                     double short_Td = -std::numeric_limits<double>::infinity());

/// The cheapest point whose ln of the cost is below `below`; empty if there is none.
std::optional<Candidate> lowest_cost(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                     double below = std::numeric_limits<double>::infinity());

/// The cheapest design found by a scan with wider limits and moved within the true ones, if ln of its cost is below
/// `below`. Separate sets of high gain, which may be narrower than a scan's spacing, are larger with wider limits.
std::optional<Candidate> lowest_cost_island(const Sweep& sweep, const DesignProblem& problem, double below);

}  // namespace tunewright::robust
