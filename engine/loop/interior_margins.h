// Margins of a loop whose dead time turns L any number of times between two points of its grid.
//
// 1. Between neighbours that a dead time turns by less than a radian, L crosses the real axis and the unit circle at
//    most once: where its sign, or |L| - 1, changes.
// 2. Where it turns by more, crossings of the real axis lie 2 pi/delay apart, all along a |L| that rises or falls. The
//    one nearest to -1 is the first beside the place where |L| = 1; where there is none, the first beside the top of
//    |L|: that of a hill between three points of the grid, else the end at which |L| is larger.
// 3. From there the axis is walked along in strides of a quarter of a radian of the dead time, to the first change of
//    sign on the negative side on either hand, which is located to rounding.
// 4. Stretches whose |L| is smaller than at a crossing that is known are left out.
//
// L without the dead time must change little from point to point: the grid has points of its
// own around corners and resonances. At a coarser one a crossing beside a hill between two points would be missed.
//
//   const Margins margins = find_interior_margins(open_loop, grid, plant.dead_time());
#pragma once

#include <complex>
#include <functional>

#include "engine/loop/frequency_grid.h"
#include "engine/loop/margins.h"

namespace tunewright {

/// Crossings within the grid, without the limits at its ends. `open_loop`: L as a function of omega; `delay` >= 0: the
/// dead time that turns it.
Margins find_interior_margins(const std::function<std::complex<double>(double)>& open_loop, const LoopGrid& grid,
                              double delay);

}  // namespace tunewright
