// What an entry of the method rimc adds.
#pragma once

#include "api/describe/description.h"
#include "engine/request/rimc_entry.h"

namespace tunewright::api {

const Description<RimcEntry>& rimc_contract();

}  // namespace tunewright::api
