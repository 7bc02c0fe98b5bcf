// What a list shows of a job that has ended: a line of JSON that is kept beside it, so that no list reads results.
#pragma once

#include <string>

#include "api/contract/request.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// JobOutline of the document, in two steps: the request is gone when there is a result.
///
/// `plant` is that of the request or of the model found in its record, cut to its type where it is long; the figures
/// are those of the first entry in the ranking that was tuned, and beside them those of today's settings. A few hundred
/// bytes, whatever the size of the result. What a failed job's line holds, its error alone, is error_outline():
/// there is no result to write it from, and often no request that could be read.
class Outline {
public:
    explicit Outline(const JobRequest& request);

    /// The line as JSON text, of a result to that request, whole or partial.
    /// `result`: of that request.
    std::string of(const TuningResult& result) const;

private:
    std::string units_;  ///< JSON; "" if none
    std::string plant_;  ///< JSON; "" of a record
};

/// A failed job as a list shows it, from its problem's text.
std::string error_outline(const std::string& problem_json);

}  // namespace tunewright::api
