// The plants of the contract.
#pragma once

#include "api/describe/union.h"
#include "engine/plant/plant.h"

namespace tunewright::api {

const Union<Plant>& plant_contract();

}  // namespace tunewright::api
