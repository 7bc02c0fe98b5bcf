// The answers of a check: each loop, and what they say together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/check/together/plant_check.h"
#include "engine/request/check/ask_check.h"

namespace tunewright::api {

struct CheckAnswer {
    CheckResult check;
    std::optional<Units> units;
    std::string request_hash;
    std::vector<std::string> notes;  ///< findings about the files, if there is no request
};

/// The result of a job.
const Description<CheckAnswer>& check_result_contract();

/// The common judgement of the loops of a batch.
struct BatchCheck {
    std::vector<std::string> loops;  ///< each as JSON, in the order of the batch
    check::PlantCheck plant;
    std::vector<check::Change> changes;  ///< of `compared`
    struct Compared {
        std::size_t loop = 0;  ///< place in loops
        std::string tag;
    };
    std::vector<Compared> compared;
    std::vector<std::string> only_now, only_before;  ///< tags without a counterpart
    bool complete = false;
    int failed = 0;
};

/// The answer of GET /v1/batches/{id}/check.
const Description<BatchCheck>& batch_check_contract();

/// The answer of POST /v1/check.
const Description<CheckResult>& check_answer_contract();

}  // namespace tunewright::api
