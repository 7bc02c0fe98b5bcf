// Answers of the contract about controllers: a tuning result, and the evaluation of controllers that were sent. Answers
// are only written; their descriptions read nothing.
#pragma once

#include <string>

#include "api/contract/record.h"
#include "engine/request/evaluate_all.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// A conclusion of a verdict.
const Description<verdict::Finding>& finding_contract();

/// A tuning result with members that only the request has. Its times, gains and figures are in the units of the
/// request: `units` holds their labels and nothing is converted.
struct ResultAnswer {
    TuningResult result;
    std::optional<Units> units;  ///< as sent; left out of the answer if none were sent
    std::string request_hash;    ///< SHA-256 of the request in its canonical form, 64 hexadecimal digits
};

/// The result of a job. An entry whose method found no controller has its `error` instead of the evaluation's members;
/// `model` is left out if the request had a plant, `operating_point` and `linear_model` if the plant is linear.
const Description<ResultAnswer>& result_contract();

/// The answer of POST /v1/design.
const Description<TuningResult>& design_answer_contract();

/// The answer of POST /v1/evaluate: the same entries, without the members of a method.
const Description<EvaluationResult>& evaluate_answer_contract();

}  // namespace tunewright::api
