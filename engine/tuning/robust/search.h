// The searches of a robust design. The default one, `fast`:
//
//  1. Scan (Ti, Td) for the largest gain within the limits, each with a stable loop: the usual box, and where it shows
//     nothing the slow and the close one (starts.h).
//  2. Start from the cheapest of the points with the least integrated error and of its optimum, which needs no runs
//     (Garpinger and Hagglund 2008; Hast et al. 2013); sequential quadratic programming from there (sqp.h).
//  3. PID: a run that ended at a short Td is tried against a PI and against the cheapest point of a long one.
//  4. PID: further valleys. Under a limit on Mks, from the cheapest point of each Td; with a set-point step, from long
//     Ti; with a slow zero, from long filters; on a resonant plant, from the wide box's valleys, from an integral alone
//     and from islands that wider limits show. A rough run shows how deep a valley is; only one that may be the deepest
//     is followed to its end.
//  5. The weighted objective: from the optima of its two parts.
//  6. Where the cost has kinks (set-point steps, resonant plants): simplices from the best, while they win.
//
// The cheapest design counts. The others are the paper's own, Nelder-Mead and gridding over (Ti, Td): Kp is eliminated,
// as the cheapest gain within the limits, at an end of a gap between the forbidden ones (Garpinger and Hagglund 2008,
// Eq. 6).
#pragma once

#include <optional>

#include "engine/tuning/robust/robust.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

/// A coarse scan, the optimum of the integrated error as a start, then the true cost by quadratic programming; from
/// further starts where there may be more than one valley. Empty: no feasible controller was seen.
std::optional<DesignResult> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report);

/// Whether a pair of poles is damped so little that designs may lie in several valleys.
bool is_resonant(const LinearPlant& plant);

/// Nelder-Mead from a simplex with corners (Ti, Td), (0.4 Ti, Td), (Ti, 0.4 Td) (Garpinger and Hagglund 2008,
/// section 4.2).
std::optional<DesignResult> nelder_mead_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                               const Report& report);

/// Gridding around (Ti, Td), refined three times around the best cell. `surface`, if given, receives the cost over the
/// first grid.
std::optional<DesignResult> grid_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                        CostSurface* surface, const Report& report);

}  // namespace tunewright::robust
