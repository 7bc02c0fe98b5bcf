// The interface of a loop over frequency, of any kind, that peaks and margins need.
//
//   const LoopGrid grid = make_peak_grid(loop);       // of a Loop, SampledLoop, ImcLoop or MeasuredLoop
//   const Peaks peaks = find_peaks(loop, grid);       // one grid serves peaks and margins alike
//   const Margins margins = find_margins(loop, grid);
#pragma once

#include <concepts>
#include <functional>

#include "engine/loop/frequency_grid.h"
#include "engine/loop/stability.h"

namespace tunewright {

/// - `at`: the loop at omega > 0, as far up as its grid goes.
/// - `ends`: the loop's limits at those ends of its axis that it knows, omega ascending from 0 to infinity or to pi/Ts;
///   L is real or infinite there; of the other functions only the magnitudes count.
/// - `turning_time` >= 0: the dead time that turns L between points of the grid, rad for one rad/time.
template <class L>
concept FrequencyLoop = requires(const L& loop, double omega) {
    { loop.at(omega) } -> std::same_as<LoopPoint>;
    { loop.ends() } -> std::same_as<LoopGrid>;
    { loop.turning_time() } -> std::same_as<double>;
    { make_loop_grid(loop) } -> std::same_as<LoopGrid>;
    { count_unstable_poles(loop) } -> std::same_as<StabilityCount>;
};

/// Any of them, which must outlive this.
struct AnyLoop {
    template <FrequencyLoop L>
    AnyLoop(const L& loop)  // NOLINT(google-explicit-constructor)
        : at([&loop](double omega) { return loop.at(omega); }), ends(loop.ends()), turning_time(loop.turning_time()) {}

    std::function<LoopPoint(double)> at;
    LoopGrid ends;
    double turning_time;
};

/// True if the loop exists and is stable.
template <FrequencyLoop L>
bool is_stable(const Expected<L>& loop) {
    return loop && count_unstable_poles(*loop).stable();
}

}  // namespace tunewright
