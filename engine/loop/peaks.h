// The largest values of |S|, |T| and |C S| over all frequencies, both ends included.
#pragma once

#include <functional>

#include "engine/loop/frequency_grid.h"

namespace tunewright {

struct Peak {
    double value = 0;  ///< sup over 0 <= omega <= infinity; infinite for |C S| of a derivative without filter
    double omega = 0;  ///< where; 0 or infinity if the supremum is a limit
};

struct Peaks {
    Peak S, T, CS;
};

/// Peaks of a stable loop, refined between grid points to a relative error below 1e-9 where the grid is resolved;
/// beyond it (dead time turning faster than any grid) the envelope's maximum is searched turn by turn.
Peaks find_peaks(const Loop& loop, const LoopGrid& grid);

/// That of |S| alone, at a third of the cost.
Peak find_sensitivity_peak(const Loop& loop, const LoopGrid& grid);

/// Peaks of any stable loop among and between the grid's points, without what lies beyond them.
Peaks find_interior_peaks(const std::function<LoopPoint(double)>& at, const LoopGrid& grid);

/// That of |S| alone; those of |T| and |C S| are infinite, so that nothing raises them.
Peaks find_interior_sensitivity_peak(const std::function<LoopPoint(double)>& at, const LoopGrid& grid);

/// Where S moves little between neighbours of the grid, the dead time may still turn L between them, and C S with it:
/// |1 + L| is at least |1 - |L||, and near its values at both ends where the turn is short. Looks there, up to
/// `resolved_to`, where that lets a peak be higher. `time`: rad of turning for one rad/time.
void raise_by_turns(const std::function<LoopPoint(double)>& at, double time, const LoopGrid& grid, Peaks& peaks);

/// A grid fine enough for `find_peaks` also where all of |S| - 1 is small.
LoopGrid make_peak_grid(const Loop& loop);

}  // namespace tunewright
