// The plants of the contract.
#pragma once

#include "api/describe/union.h"
#include "engine/plant/plant.h"

namespace tunewright::api {

/// One linear plant; answers carry only these.
const Union<Plant>& plant_contract();

/// What a request may be about: a linear plant, several, measured points of one, or differential equations.
const Union<PlantModel>& plant_model_contract();

}  // namespace tunewright::api
