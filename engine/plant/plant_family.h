// Every plant that one controller must serve: a nominal one, others beside it, each perhaps with uncertain parameters.
#pragma once

#include <vector>

#include "engine/plant/plant_model.h"
#include "engine/plant/plant_region.h"

namespace tunewright {

/// One region for each plant, of dimension 0 where nothing about it is uncertain; the first is around the nominal
/// plant.
struct PlantFamily {
    std::vector<PlantRegion> regions;

    const Plant& nominal() const { return regions.front().nominal(); }
    bool single() const { return regions.size() == 1 && regions.front().dimension() == 0; }
};

PlantFamily family_of(const Plant& plant);
PlantFamily family_of(const PlantSet& set);

/// The plants at the ends of every region, the nominal plant itself left out.
std::vector<Plant> members_beside_nominal(const PlantFamily& family);

}  // namespace tunewright
