// Margins of a loop whose dead time may turn L any number of times between two points of its grid.
//
// 1. Between neighbours where the dead time turns L by less than a radian, L crosses the real axis and the unit circle
//    at
//    most once: where its sign, or |L| - 1, changes.
// 2. Where it turns L by more, crossings of the real axis lie 2 pi/delay apart while |L| rises or falls. The
//    one nearest to -1 is the first next to the point with |L| = 1; without such a point, the first next to the maximum
//    of |L|: a local one between three points of the grid, else the end at which |L| is larger.
// 3. From there L is evaluated in strides of a quarter of a radian of the dead time, up to the first change of
//    sign on the negative side in each direction, which is located to rounding.
// 4. Intervals in which |L| is smaller than at a known crossing are skipped.
//
// L without the dead time must change little from point to point: the grid has extra points around corners and
// resonances. A coarser grid would miss a crossing next to a maximum between two points.
//
//   const Margins margins = find_interior_margins(open_loop, grid, plant.dead_time());
#pragma once

#include <complex>
#include <functional>

#include "engine/loop/frequency_grid.h"
#include "engine/loop/margins.h"

namespace tunewright {

/// Crossings within the grid, without the limits at its ends. `open_loop`: L as a function of omega; `delay` >= 0: its
/// dead time.
Margins find_interior_margins(const std::function<std::complex<double>(double)>& open_loop, const LoopGrid& grid,
                              double delay);

}  // namespace tunewright
