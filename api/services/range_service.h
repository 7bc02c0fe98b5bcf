// Jobs and calls about an operating range.
#pragma once

#include <string_view>

#include "api/contract/range/range_request.h"
#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The answer to a request whose hash is known.
JobOutcome range_outcome(RangeRequest request, std::string_view hash, const RunControl& control);

Answer range_call(std::string_view body, const RunControl& control);              ///< POST /v1/range
Answer range_experiments_call(std::string_view body, const RunControl& control);  ///< POST /v1/experiments/range

}  // namespace tunewright::api
