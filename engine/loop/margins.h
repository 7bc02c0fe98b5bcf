// Gain, phase and delay margins over all crossings.
#pragma once

#include <functional>

#include "engine/loop/frequency_grid.h"

namespace tunewright {

/// Of a stable loop. Infinite where nothing is lost at any value.
struct Margins {
    double gain_margin;      ///< smallest factor > 1 that loses stability; infinity if none
    double gain_margin_low;  ///< largest factor < 1 that loses stability; 0 if none
    double phase_margin;     ///< rad, smallest distance of arg L from -180 degrees over all |L| = 1; infinity without
                             ///< crossing
    double delay_margin;  ///< smallest extra dead time that loses stability; infinity if none; 0 where L(infinity) > 1
                          ///< without dead time
    double gain_crossover;   ///< omega of the phase margin; 0 if there is none
    double phase_crossover;  ///< omega of the gain margin (of the lower one if only that exists); 0 without crossing
};

Margins find_margins(const Loop& loop, const LoopGrid& grid);

/// Of any loop, from its gain as a function of omega: crossings within the grid, without the limits at its ends.
Margins find_interior_margins(const std::function<std::complex<double>(double)>& open_loop, const LoopGrid& grid);

}  // namespace tunewright
