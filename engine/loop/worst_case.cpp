#include "engine/loop/worst_case.h"

#include <cmath>
#include <limits>

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFirstStep = 0.5, kLastStep = 0.02;

double cost_at(const PlantRegion& region, const PlantCost& cost, const PlantRegion::Point& z) {
    const auto plant = LinearPlant::make(region.at(z));
    return plant ? cost(*plant) : kInfinity;
}

}  // namespace

WorstCase find_worst_case(const PlantRegion& region, const PlantCost& cost,
                          const std::vector<PlantRegion::Point>& starts, const std::stop_token& stop) {
    WorstCase worst{starts.front(), -kInfinity};
    const auto try_point = [&](const PlantRegion::Point& z) {
        if (stop.stop_requested() || worst.cost == kInfinity) return false;
        const double value = cost_at(region, cost, z);
        if (!(value > worst.cost)) return false;
        worst = {z, value};
        return true;
    };
    for (const auto& z : starts) try_point(z);
    const auto n = static_cast<std::size_t>(region.dimension());
    for (double step = kFirstStep; step >= kLastStep;) {
        bool better = false;
        for (std::size_t k = 0; k < n; ++k)
            for (const double side : {step, -step}) {
                PlantRegion::Point z = worst.z;
                z[k] += side;
                z = region.inside(z);
                if (z != worst.z) better = try_point(z) || better;
            }
        if (!better) step /= 2;
    }
    return worst;
}

double log_sensitivity_peak(const LinearPlant& plant, const ParallelPid& controller) {
    const auto loop = Loop::make(plant, controller);
    if (!loop || !count_unstable_poles(*loop).stable()) return kInfinity;
    const double peak = find_sensitivity_peak(*loop, make_loop_grid(*loop)).value;
    return peak > 0 ? std::log(peak) : kInfinity;
}

}  // namespace tunewright
