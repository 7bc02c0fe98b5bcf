// The results of a job and of a call.
#pragma once

#include <string>

#include "api/json/problem.h"

namespace tunewright::api {

struct JobOutcome {
    enum class Status { succeeded, failed, cancelled };
    Status status = Status::failed;
    std::string result_json;        ///< of succeeded; of cancelled with a feasible design ("partial": true); else empty
    std::string error_json;         ///< problem object of failed; else empty
    std::string method = {};        ///< the method asked for; "several" of more than one; "none" of a request with none
    std::string outline_json = {};  ///< of a result: what a list shows of it (JobOutline in the document)
};

/// Status and body of a synchronous call; the media type is problem+json from 400 on.
struct Answer {
    int status = 200;
    std::string body;
};

/// The answer to a call that cannot be done.
inline Answer refusal(const Problem& problem) { return {problem.status, to_json(problem)}; }

}  // namespace tunewright::api
