// Plants described by differential equations in text.
#pragma once

#include "api/describe/description.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright::api {

const Description<NonlinearPlant>& nonlinear_plant_contract();

}  // namespace tunewright::api
