// How a job about one question ends, whatever the question is.
#pragma once

#include <string>
#include <utility>

#include "api/outcome.h"

namespace tunewright::api {

/// The outcome of a job without a result: it was stopped, or failed with the problem.
inline JobOutcome without_result(std::string method, const Problem& problem, bool stopped) {
    JobOutcome outcome;
    outcome.method = std::move(method);
    outcome.status = stopped ? JobOutcome::Status::cancelled : JobOutcome::Status::failed;
    if (!stopped) outcome.error_json = to_json(problem);
    return outcome;
}

/// `partial`: the job was stopped, and the result is the best until then.
inline JobOutcome with_result(std::string method, bool partial, std::string outline, std::string result) {
    JobOutcome outcome;
    outcome.method = std::move(method);
    outcome.status = partial ? JobOutcome::Status::cancelled : JobOutcome::Status::succeeded;
    outcome.outline_json = std::move(outline);
    outcome.result_json = std::move(result);
    return outcome;
}

}  // namespace tunewright::api
