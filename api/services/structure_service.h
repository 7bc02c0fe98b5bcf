// Calls and jobs about loops around the loop.
#pragma once

#include <string_view>

#include "api/contract/structure/cascade_call.h"
#include "api/contract/structure/feedforward_call.h"
#include "api/contract/structure/interaction_call.h"
#include "api/contract/structure/level_call.h"
#include "api/contract/structure/predictor_call.h"
#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The answers to requests whose hash is known.
JobOutcome structure_outcome(const CascadeRequest& request, std::string_view hash, const RunControl& control);
JobOutcome structure_outcome(const LevelRequest& request, std::string_view hash, const RunControl& control);
JobOutcome structure_outcome(const FeedforwardRequest& request, std::string_view hash, const RunControl& control);
JobOutcome structure_outcome(const InteractionRequest& request, std::string_view hash, const RunControl& control);
JobOutcome structure_outcome(const PredictorRequest& request, std::string_view hash, const RunControl& control);

Answer cascade_call(std::string_view body, const RunControl& control);      ///< POST /v1/cascade
Answer level_call(std::string_view body, const RunControl& control);        ///< POST /v1/level
Answer feedforward_call(std::string_view body, const RunControl& control);  ///< POST /v1/feedforward
Answer interaction_call(std::string_view body, const RunControl& control);  ///< POST /v1/interaction
Answer predictor_call(std::string_view body, const RunControl& control);    ///< POST /v1/predictor

}  // namespace tunewright::api
