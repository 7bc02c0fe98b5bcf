// The worst plant in a region for a given controller.
#pragma once

#include <functional>
#include <stop_token>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// Cost of a controller on a plant, e.g. ln Ms; infinite if the loop is unstable.
using PlantCost = std::function<double(const LinearPlant&)>;

struct WorstCase {
    PlantRegion::Point z;
    double cost = 0;
};

/// Points of a region that are evaluated before the search starts from the worst of them.
constexpr int kRegionSamples = 128;

/// The largest `cost` near the worst of `starts` (at least one): a compass search in z, from steps of a half down to a
/// fiftieth, kept inside the region. A plant that cannot be formed (gain 0) has infinite cost. The search ends at the
/// first infinite cost, or when `stop` is set.
WorstCase find_worst_case(const PlantRegion& region, const PlantCost& cost,
                          const std::vector<PlantRegion::Point>& starts, const std::stop_token& stop = {});

/// ln of the largest |S| of the loop, negative if it is below 1; infinite if the loop is unstable, cannot be formed, or
/// has a peak that cannot be determined.
double log_sensitivity_peak(const LinearPlant& plant, const ParallelPid& controller);

}  // namespace tunewright
