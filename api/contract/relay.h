// Relay tests of the contract: a plant and a relay in the request; record, steady limit cycle and plan in the answer. A
// record of a relay test shows the same limit cycle.
#pragma once

#include <string>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/request/tune.h"
#include "engine/simulation/relay/limit_cycle.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright::api {

const Description<UltimatePoint>& ultimate_point_contract();
/// A subject instead of a plant or a record: Ku != 0 [u/y], Pu > 0 [time], and the static gain K != 0 [y/u] if it is
/// known.
const Description<UltimateTest>& ultimate_contract();
const Description<LimitCycle>& limit_cycle_contract();
const Description<FrequencyPoint>& frequency_point_contract();

struct RelayRequest {
    std::optional<std::string> name;  ///< a label
    std::optional<Units> units;       ///< labels; nothing is converted
    std::optional<Plant> plant;       ///< set in every request that was read without a fault
    RelaySettings relay;
};

/// Reading applies the engine's checks of plant and relay; each of its errors becomes a fault of the member that it
/// names.
const Description<RelayRequest>& relay_request_contract();
/// The whole answer of POST /v1/experiments/relay; times in the plant's unit of time.
const Description<RelayExperiment>& relay_answer_contract();

}  // namespace tunewright::api
