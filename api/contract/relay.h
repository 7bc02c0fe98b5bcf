// Relay tests of the contract: a plant and a relay in; record, steady limit cycle and plan out.
#pragma once

#include <string>

#include "api/contract/record.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright::api {

struct RelayRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<Plant> plant;
    RelaySettings relay;
};

/// Checks plant and relay, each as the engine would.
const Description<RelayRequest>& relay_request_contract();
const Description<RelayExperiment>& relay_answer_contract();

}  // namespace tunewright::api
