// Every figure of a result computed again by a second, slower way (engine/verify), with the differences.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "api/chosen_entry.h"
#include "api/contract/result/verify_call.h"
#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

/// Problems: 400 not JSON; 404 not a result; 422 without its request, or a request that is not valid; 504 if it was
/// stopped.
std::variant<VerifyAnswer, Problem> verify_result(const ResultSource& source, const RunControl& control);

std::string verify_json(const VerifyAnswer& answer);

/// POST /v1/verify: {request, result}, or a whole job.
Answer verify_call(std::string_view body, const RunControl& control);

}  // namespace tunewright::api
