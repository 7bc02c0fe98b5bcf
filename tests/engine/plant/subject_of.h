// A plant without faults, in the form for requests.
#pragma once

#include "engine/plant/analysed_plant.h"

namespace tunewright::test {

/// Throws std::bad_variant_access if the plant has a fault.
inline AnalysedPlant subject_of(const PlantModel& plant) { return std::get<AnalysedPlant>(AnalysedPlant::make(plant)); }

}  // namespace tunewright::test
