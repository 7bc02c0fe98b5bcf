// What a relay test shows, in the contract: of records and of simulated tests.
#pragma once

#include "api/describe/description.h"
#include "engine/simulation/relay/limit_cycle.h"

namespace tunewright::api {

const Description<UltimatePoint>& ultimate_point_contract();
const Description<LimitCycle>& limit_cycle_contract();
const Description<FrequencyPoint>& frequency_point_contract();

}  // namespace tunewright::api
