// How one controller serves every plant of a family.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// `stable_fraction`: of each region, by 128 points spread uniformly over its parameters, the mean over the plants of a
/// set; 1 only where no unstable plant was found anywhere. `worst_Ms`: the largest at those points, at the regions'
/// ends and where a local search from the worst of them leads.
RegionFigures region_figures(const PlantFamily& family, const ParallelPid& controller);

}  // namespace tunewright
