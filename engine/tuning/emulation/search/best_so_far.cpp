#include "engine/tuning/emulation/search/best_so_far.h"

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright::emulation {

std::optional<BestSoFar> best_so_far(const LinearPlant& plant, const Pid& pid) {
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    if (plant.dead_time() > 0 && loop->high_frequency_gain() >= 1) return std::nullopt;
    const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
    const auto response = simulate_linear(plant, loop->gains(), {0, 1}, {});
    if (!response.settles) return std::nullopt;
    const auto integrals = error_integrals(response.nodes, 0, response.error_integral_final);
    return BestSoFar{pid, integrals.IAE, peaks.S.value, peaks.T.value};
}

}  // namespace tunewright::emulation
