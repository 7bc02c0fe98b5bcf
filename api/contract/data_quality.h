// What was found in a record, of the contract.
#pragma once

#include "api/describe/description.h"
#include "engine/identification/identify.h"

namespace tunewright::api {

const Description<DataQuality>& quality_contract();

}  // namespace tunewright::api
