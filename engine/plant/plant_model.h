// What a request may be about: one linear plant (perhaps with uncertain parameters), several, measured points of one,
// or differential equations.
#pragma once

#include <variant>
#include <vector>

#include "engine/plant/frequency_response.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// Several plants that one controller must serve. The first is nominal; at least one.
struct PlantSet {
    std::vector<Plant> plants;
};

using PlantModel = std::variant<Plant, PlantSet, FrequencyResponse, NonlinearPlant>;

}  // namespace tunewright
