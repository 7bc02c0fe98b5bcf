// Relay tests of the contract: a plant and a relay in; record, steady limit cycle and plan out. A record of a relay
// test shows the same limit cycle.
#pragma once

#include <string>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/request/tune.h"
#include "engine/simulation/relay/limit_cycle.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright::api {

const Description<UltimatePoint>& ultimate_point_contract();
/// In place of a plant or a record: Ku != 0 [u/y], Pu > 0 [time], and the static gain K != 0 [y/u] where it is known.
const Description<UltimateTest>& ultimate_contract();
const Description<LimitCycle>& limit_cycle_contract();
const Description<FrequencyPoint>& frequency_point_contract();

struct RelayRequest {
    std::optional<std::string> name;  ///< a label
    std::optional<Units> units;       ///< labels; nothing is converted
    std::optional<Plant> plant;       ///< set in every request that was read without a fault
    RelaySettings relay;
};

/// Reading checks plant and relay as the engine would; each of its errors becomes a fault of the member that it names.
const Description<RelayRequest>& relay_request_contract();
/// The whole answer of POST /v1/experiments/relay; times in the plant's unit of time.
const Description<RelayExperiment>& relay_answer_contract();

}  // namespace tunewright::api
