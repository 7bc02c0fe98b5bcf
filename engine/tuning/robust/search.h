// The searches of a robust design. The default one, `fast`:
//
//  1. Scan (Ti, Td) for the largest gain with a stable loop within the limits: the usual box, and if it has none
//     the slow and the close one (starts.h).
//  2. Start from the cheapest of the points with the least integrated error and of its optimum, which needs no runs
//     (Garpinger and Hägglund 2008; Hast et al. 2013); run sequential quadratic programming from there (sqp.h).
//  3. PID: compare a run that ended at a short Td with a PI and with a run from the cheapest point with a long Td.
//  4. PID: search further local minima. With a limit on Mks, from the cheapest point of each Td; with a set-point step,
//     from long Ti; with a slow zero, from long filters; for a resonant plant, from the minima of the wide box, from
//     integral action alone and from separate sets that wider limits reveal. A rough run estimates each minimum; only
//     one that may be the best is followed to its end.
//  5. For the weighted objective, run from the optima of its two parts.
//  6. If the cost has kinks (set-point steps, resonant plants), refine the best design by simplices while they
//     improve it.
//
// The result is the cheapest design. The other searches are those of the paper, Nelder-Mead and gridding over (Ti, Td):
// Kp is eliminated as the cheapest gain within the limits, at an end of a gap between the forbidden gains (Garpinger
// and Hägglund 2008, Eq. 6).
#pragma once

#include <optional>

#include "engine/tuning/robust/robust.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

/// A coarse scan, the optimum of the integrated error as a start, then sequential quadratic programming for the true
/// cost, from further starts if there may be several local minima. Empty: no feasible controller was found.
std::optional<DesignResult> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report);

/// Nelder-Mead from a simplex with corners (Ti, Td), (0.4 Ti, Td), (Ti, 0.4 Td) (Garpinger and Hägglund 2008,
/// section 4.2).
std::optional<DesignResult> nelder_mead_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                               const Report& report);

/// Gridding around (Ti, Td), refined three times around the best cell. `surface`, if given, receives the cost over the
/// first grid.
std::optional<DesignResult> grid_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                        CostSurface* surface, const Report& report);

}  // namespace tunewright::robust
