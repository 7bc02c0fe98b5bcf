// The largest values of |S|, |T| and |C S| over all frequencies, both ends included.
#pragma once

#include <functional>

#include "engine/loop/frequency_grid.h"

namespace tunewright {

struct Peak {
    double value = 0;  ///< sup over 0 <= omega <= infinity; infinite for |C S| of a derivative without filter
    double omega = 0;  ///< frequency of the maximum; 0 or infinity if the supremum is a limit
};

struct Peaks {
    Peak S, T, CS;
};

/// Peaks of a stable loop, refined between grid points to a relative error below 1e-9 where the grid is resolved;
/// beyond it (the dead time turns L faster than any grid resolves) the envelope's maximum is searched turn by turn.
Peaks find_peaks(const Loop& loop, const LoopGrid& grid);

/// The peak of |S| alone, at a third of the cost.
Peak find_sensitivity_peak(const Loop& loop, const LoopGrid& grid);

/// Peaks of any stable loop at and between the grid's points, without the limits beyond them.
Peaks find_interior_peaks(const std::function<LoopPoint(double)>& at, const LoopGrid& grid);

/// The peak of |S| alone; those of |T| and |C S| are set to infinity, so that nothing raises them.
Peaks find_interior_sensitivity_peak(const std::function<LoopPoint(double)>& at, const LoopGrid& grid);

/// Where S moves little between neighbours of the grid, the dead time may still turn L between them, and C S with it:
/// |1 + L| is at least |1 - |L||, and for a short turn it is close to its values at both ends. Evaluates the loop
/// there, up to `resolved_to`, if these bounds allow a higher peak. `time`: rad of turning for one rad/time.
void raise_by_turns(const std::function<LoopPoint(double)>& at, double time, const LoopGrid& grid, Peaks& peaks);

/// A grid that is fine enough for `find_peaks` even if all of |S| - 1 is small.
LoopGrid make_peak_grid(const Loop& loop);

}  // namespace tunewright
