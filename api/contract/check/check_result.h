// The answers of a check: each loop, and what they say together.
#pragma once

#include <optional>
#include <string>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/request/check/ask_check.h"

namespace tunewright::api {

struct CheckAnswer {
    CheckResult check;
    std::optional<Units> units;
    std::string request_hash;
};

/// The result of a job.
const Description<CheckAnswer>& check_result_contract();

/// The answer of POST /v1/check.
const Description<CheckResult>& check_answer_contract();

}  // namespace tunewright::api
