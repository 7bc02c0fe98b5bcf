// The plants of the contract.
#pragma once

#include "api/describe/union.h"
#include "engine/plant/plant.h"

namespace tunewright::api {

/// One linear plant by its object; answers have only these. Requests take plant_or_text (typed.h).
const Union<Plant>& plant_contract();

/// The subject of a request, as objects: a linear plant, several, measured points of one, or differential equations.
const Union<PlantModel>& plant_model_contract();

}  // namespace tunewright::api
