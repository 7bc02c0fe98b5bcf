// What an entry says of the loop as it is built.
#pragma once

#include "api/describe/description.h"
#include "engine/request/as_built.h"

namespace tunewright::api {

/// {"sample_time", "robustness", "performance", "responses", "difference"}.
const Description<AsBuilt>& implemented_contract();

}  // namespace tunewright::api
