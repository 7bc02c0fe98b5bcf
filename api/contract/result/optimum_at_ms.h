// How far an entry lies above the optimum at its Ms.
#pragma once

#include "api/describe/description.h"
#include "engine/request/optimum_at_ms.h"

namespace tunewright::api {

const Description<OptimumAtMs>& optimum_contract();

}  // namespace tunewright::api
