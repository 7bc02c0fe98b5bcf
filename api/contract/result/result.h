// Answers of the contract: a tuning result, evaluated controllers, an identified model.
#pragma once

#include <string>

#include "api/contract/record.h"
#include "engine/request/evaluate_all.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// A tuning result with what only the request knew.
struct ResultAnswer {
    TuningResult result;
    std::optional<Units> units;
    std::string request_hash;
};

struct IdentifyAnswer {
    IdentifiedModel model;
};

const Description<ResultAnswer>& result_contract();
const Description<EvaluationResult>& evaluate_answer_contract();
const Description<IdentifyAnswer>& identify_answer_contract();

}  // namespace tunewright::api
