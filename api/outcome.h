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
    std::string method = {};        ///< the method asked for; "several" for more than one; "none" for a request without
                                    ///< one
    std::string outline_json = {};  ///< of a result: the fields for a list (JobOutline in the document)
};

/// Status and body of a synchronous call; the media type is problem+json for a status of 400 or more.
struct Answer {
    int status = 200;
    std::string body;
};

/// The answer to a call that is refused.
inline Answer refusal(const Problem& problem) { return {problem.status, to_json(problem)}; }

}  // namespace tunewright::api
