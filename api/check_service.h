// Jobs and calls that check loops in operation.
#pragma once

#include <string_view>

#include "api/contract/check/check_request.h"
#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The answer to a request whose hash is known.
JobOutcome check_outcome(CheckRequest request, std::string_view hash, const RunControl& control);

Answer check_call(std::string_view body, const RunControl& control);  ///< POST /v1/check

}  // namespace tunewright::api
