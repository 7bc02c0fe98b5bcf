// The largest values of |S|, |T| and |C S| over all frequencies, both ends included.
#pragma once

#include <optional>

#include "engine/loop/frequency_loop.h"

namespace tunewright {

struct Peak {
    double value = 0;  ///< sup over 0 <= omega <= infinity; infinite for |C S| of a derivative without filter
    double omega = 0;  ///< frequency of the maximum; 0 or infinity if the supremum is a limit
};

struct Peaks {
    Peak S, T, CS;
};

/// Peaks of a stable loop, refined between grid points to a relative error below 1e-9 where the grid is resolved, its
/// ends included. Between neighbours with similar S the dead time may still turn L, and C S with it; those turns are
/// searched in which a peak can be higher. Beyond the resolved range of a loop that goes on to infinity the envelope's
/// maximum is searched turn by turn.
Peaks find_peaks(const AnyLoop& loop, const LoopGrid& grid);

/// The peak of |S| alone, at a third of the cost.
Peak find_sensitivity_peak(const AnyLoop& loop, const LoopGrid& grid);

/// The grid, refined if |S| - 1 is small everywhere, so that its maximum is flat. `enough_below`: as in Refinement.
LoopGrid refined_at_low_peak(const AnyLoop& loop, LoopGrid grid, double enough_below = 0);

/// A grid that is fine enough for `find_peaks` even if all of |S| - 1 is small.
template <FrequencyLoop L>
LoopGrid make_peak_grid(const L& loop) {
    return refined_at_low_peak(loop, make_loop_grid(loop));
}

/// Peaks on the loop's own grid; empty where there is no loop or it is not stable.
template <FrequencyLoop L>
std::optional<Peaks> stable_peaks(const Expected<L>& loop) {
    return is_stable(loop) ? std::optional(find_peaks(*loop, make_loop_grid(*loop))) : std::nullopt;
}

}  // namespace tunewright
