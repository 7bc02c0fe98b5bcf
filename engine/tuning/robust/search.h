// The three searches of a robust design: the default one, and the paper's own in the (Ti, Td) plane, with Kp eliminated
// by tangency (Nelder-Mead and gridding).

#pragma once

#include <optional>

#include "engine/tuning/robust/robust.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

/// A coarse scan, the optimum of the integrated error as a start, then the true cost by quadratic programming; from
/// further starts where there may be more than one valley. Empty: no feasible controller was seen.
std::optional<Found> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report);

/// Whether a pair of poles is damped so little that designs may lie in several valleys.
bool is_resonant(const LinearPlant& plant);

/// The cheapest feasible gain for one (Ti, Td), moved onto the limit exactly; empty where no gain is feasible.
std::optional<Found> best_gain(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                               double tolerance);

/// Nelder-Mead from a simplex with corners (Ti, Td), (0.4 Ti, Td), (Ti, 0.4 Td) (Garpinger and Hagglund 2008,
/// section 4.2).
std::optional<Found> nelder_mead_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                        const Report& report);

/// Gridding around (Ti, Td), refined three times around the best cell. `surface`, if given, receives the cost over the
/// first grid.
std::optional<Found> grid_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                 CostSurface* surface, const Report& report);

}  // namespace tunewright::robust
