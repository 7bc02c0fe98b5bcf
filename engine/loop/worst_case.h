// Where in a region of plants a controller does worst.
#pragma once

#include <functional>
#include <stop_token>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// How badly a controller serves a plant, e.g. ln Ms; infinite where the loop is unstable.
using PlantCost = std::function<double(const LinearPlant&)>;

struct WorstCase {
    PlantRegion::Point z;
    double cost = 0;
};

/// Points of a region that are looked at before the worst of them is followed.
constexpr int kRegionSamples = 128;

/// The largest `cost` near the worst of `starts` (at least one): a compass search in z, from steps of a half down to
/// a fiftieth, kept inside the region. A plant that cannot be formed (gain 0) counts as infinitely bad. Ends at once
/// where it meets infinity or `stop` is set.
WorstCase find_worst_case(const PlantRegion& region, const PlantCost& cost,
                          const std::vector<PlantRegion::Point>& starts, const std::stop_token& stop = {});

/// ln of the largest |S| of the loop, negative where that is below 1; infinite where it is unstable, no loop, or where
/// the peak cannot be judged.
double log_sensitivity_peak(const LinearPlant& plant, const ParallelPid& controller);

}  // namespace tunewright
