// Source text of a test that a controller runs by itself.
#pragma once

#include <string_view>
#include <variant>

#include "api/code/code.h"

namespace tunewright::api {

/// The file for a request of POST /v1/experiments/code. Problems: 400 not JSON, 422 with every fault.
std::variant<ControllerCode, Problem> experiment_code(std::string_view body);

/// The same from parameters as they were typed.
std::variant<ControllerCode, Problem> experiment_code(const CodeWords& words);

}  // namespace tunewright::api
