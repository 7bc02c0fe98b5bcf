// Calls about loops around the loop.
#pragma once

#include <string_view>

#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

Answer cascade_call(std::string_view body, const RunControl& control);      ///< POST /v1/cascade
Answer level_call(std::string_view body, const RunControl& control);        ///< POST /v1/level
Answer feedforward_call(std::string_view body, const RunControl& control);  ///< POST /v1/feedforward
Answer interaction_call(std::string_view body, const RunControl& control);  ///< POST /v1/interaction
Answer predictor_call(std::string_view body, const RunControl& control);    ///< POST /v1/predictor

}  // namespace tunewright::api
