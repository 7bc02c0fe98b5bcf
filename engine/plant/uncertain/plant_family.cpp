#include "engine/plant/uncertain/plant_family.h"

namespace tunewright {

PlantFamily family_of(const Plant& plant) { return {{PlantRegion::of_ranges(plant)}}; }

PlantFamily family_of(const PlantSet& set) {
    PlantFamily family;
    for (const auto& plant : set.plants) family.regions.push_back(PlantRegion::of_ranges(plant));
    return family;
}

std::vector<Plant> members_beside_nominal(const PlantFamily& family) {
    std::vector<Plant> members;
    for (std::size_t i = 0; i < family.regions.size(); ++i) {
        const PlantRegion& region = family.regions[i];
        if (i > 0 && region.dimension() > 0) members.push_back(region.nominal());
        if (i == 0 && region.dimension() == 0) continue;
        for (const auto& end : region.ends()) members.push_back(region.at(end));
    }
    return members;
}

}  // namespace tunewright
