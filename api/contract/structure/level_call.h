// Levels that smooth flows: POST /v1/level.
#pragma once

#include "api/contract/structure/structure_parts.h"

namespace tunewright::api {

struct LevelRequest : StructureRequest {
    structure::LevelProblem problem;
};
const Description<LevelRequest>& level_request_contract();

struct LevelAnswer : StructureAnswer {
    structure::LevelResult result;
    double gap = 0;
};
const Description<LevelAnswer>& level_answer_contract();

}  // namespace tunewright::api
