// Jobs about an operating range, as service.h runs them.
#pragma once

#include <string_view>

#include "api/contract/range/range_request.h"
#include "api/service.h"

namespace tunewright::api {

/// The answer to a request whose hash is known.
JobOutcome range_outcome(RangeRequest request, std::string_view hash, const RunControl& control);

}  // namespace tunewright::api
