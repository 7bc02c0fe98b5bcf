// The frontier of robust optima: request and answer of POST /v1/frontier, and the report of the method frontier.
#pragma once

#include <optional>
#include <string>

#include "api/contract/request.h"
#include "engine/tuning/robust/frontier.h"

namespace tunewright::api {

struct FrontierRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;
    std::optional<AnalysedPlant> subject;  ///< the analysed `plant`
    MethodOptions options;                 ///< those of the method frontier
};

const Description<FrontierRequest>& frontier_request_contract();

const Description<Frontier>& frontier_contract();

}  // namespace tunewright::api
