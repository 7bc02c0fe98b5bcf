// Every plant that one controller must serve: a nominal one, others beside it, each perhaps with uncertain parameters.
#pragma once

#include <optional>
#include <vector>

#include "engine/figure.h"
#include "engine/plant/plant_model.h"
#include "engine/plant/uncertain/plant_region.h"

namespace tunewright {

/// One region for each plant, of dimension 0 where nothing about it is uncertain; the first is around the nominal
/// plant.
struct PlantFamily {
    std::vector<PlantRegion> regions;

    const Plant& nominal() const { return regions.front().nominal(); }
    bool single() const { return regions.size() == 1 && regions.front().dimension() == 0; }
};

/// How one controller serves every plant of a family.
struct RegionFigures {
    double stable_fraction = 0;  ///< of the family, 0 to 1
    Figure worst_Ms;             ///< empty where not every plant that was looked at is stable
    Plant worst_plant;           ///< where Ms is largest, or the loop unstable
};

PlantFamily family_of(const Plant& plant);
PlantFamily family_of(const PlantSet& set);

/// The plants at the ends of every region, the nominal plant itself left out.
std::vector<Plant> members_beside_nominal(const PlantFamily& family);

}  // namespace tunewright
