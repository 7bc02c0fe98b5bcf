// The entry of a list of jobs for one that has ended: a line of JSON that is stored with it, so that no list reads
// results.
#pragma once

#include <string>

#include "api/contract/request.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// JobOutline of the document, in two steps, because the request is gone when there is a result.
///
/// `plant` is that of the request or of the model identified from its record, only its type if it is long; the figures
/// are those of the first tuned entry in the ranking, together with those of today's settings. A few hundred bytes,
/// whatever the size of the result. The line of a failed job, its error alone, comes from error_outline(): it has no
/// result, and often no request that could be read.
class Outline {
public:
    explicit Outline(const JobRequest& request);

    /// The line as JSON text, for a result of that request, complete or partial.
    std::string of(const TuningResult& result) const;

private:
    std::string units_;  ///< JSON; "" if none
    std::string plant_;  ///< JSON; "" for a record
};

/// The line of a failed job, from its problem's text.
std::string error_outline(const std::string& problem_json);

}  // namespace tunewright::api
