#include "engine/evaluation/family_figures.h"

#include <cmath>

#include "engine/loop/worst_case.h"

namespace tunewright {
namespace {

struct RegionCheck {
    double stable_fraction = 0;
    WorstCase worst;
};

RegionCheck check(const PlantRegion& region, const ParallelPid& controller) {
    const PlantCost cost = [&](const LinearPlant& plant) { return log_sensitivity_peak(plant, controller); };
    RegionCheck result{0, {PlantRegion::Point(static_cast<std::size_t>(region.dimension()), 0.0), -INFINITY}};
    const auto look = [&](const PlantRegion::Point& z) {
        const auto plant = LinearPlant::make(region.at(z));
        const double value = plant ? cost(*plant) : INFINITY;
        if (value > result.worst.cost) result.worst = {z, value};
        return std::isfinite(value);
    };
    const auto points = region.spread(kRegionSamples);
    double looked_at = static_cast<double>(points.size()), stable = 0;
    for (const auto& z : points) stable += look(z) ? 1 : 0;
    const bool all_stable = std::isfinite(result.worst.cost);
    for (const auto& z : region.ends()) look(z);
    if (std::isfinite(result.worst.cost)) result.worst = find_worst_case(region, cost, {result.worst.z});
    // An unstable plant that the samples missed counts as one more, so that 1 always means that none is known.
    if (all_stable && !std::isfinite(result.worst.cost)) looked_at += 1;
    result.stable_fraction = stable / looked_at;
    return result;
}

}  // namespace

RegionFigures region_figures(const PlantFamily& family, const ParallelPid& controller) {
    RegionFigures figures;
    double fractions = 0, worst = -INFINITY;
    for (const auto& region : family.regions) {
        const RegionCheck found = check(region, controller);
        fractions += found.stable_fraction;
        if (found.worst.cost <= worst) continue;
        worst = found.worst.cost;
        figures.worst_plant = region.at(found.worst.z);
    }
    figures.stable_fraction = fractions / static_cast<double>(family.regions.size());
    figures.worst_Ms = finite_or(std::exp(worst), "The loop is unstable on at least one plant, such as worst_plant.");
    return figures;
}

}  // namespace tunewright
