#include "engine/loop/ultimate_point.h"

#include <cmath>
#include <numbers>

#include "engine/loop/margins.h"
#include "engine/loop/stability.h"

namespace tunewright {
namespace {

std::optional<UltimatePoint> from_stable_gain(const LinearPlant& plant, double Kp) {
    ParallelPid gains;
    gains.Kp = Kp;
    const auto loop = Loop::make(plant, gains);
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    const Margins margins = find_margins(*loop, make_loop_grid(*loop));
    if (!std::isfinite(margins.gain_margin) || !(margins.phase_crossover > 0)) return std::nullopt;
    return UltimatePoint{Kp * margins.gain_margin, 2 * std::numbers::pi / margins.phase_crossover};
}

}  // namespace

std::optional<UltimatePoint> ultimate_point(const LinearPlant& plant) {
    const double unit = 1 / plant.low_frequency_gain();
    if (!std::isfinite(unit)) return std::nullopt;
    if (plant.unstable_poles() > 0) {
        // Both signs, from weak to strong: a plant with an unstable pole is stabilised between two gains, if at all.
        for (const double sign : {-1.0, 1.0}) {
            for (double factor = 1.02; factor < 1e3; factor *= 1.15) {
                if (auto point = from_stable_gain(plant, sign * factor * unit)) return point;
            }
        }
        return std::nullopt;
    }
    // An integrating plant has no gain of its own to compare with: its slope over the time it needs is one.
    const double time = plant.integrators() > 0 ? plant.dead_time() + plant.lag_sum() : 1;
    if (!(time > 0)) return std::nullopt;
    for (const double factor : {0.2, 0.01, 1e-4}) {
        if (auto point = from_stable_gain(plant, factor * unit / std::pow(time, plant.integrators()))) return point;
    }
    return std::nullopt;
}

}  // namespace tunewright
