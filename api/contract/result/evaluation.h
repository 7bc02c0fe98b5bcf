// What is known about one controller on one plant, as answers carry it.
#pragma once

#include "api/describe/description.h"
#include "engine/evaluation/evaluation.h"

namespace tunewright::api {

const Description<Robustness>& robustness_contract();
const Description<Performance>& performance_contract();
const Description<LoadPerformance>& load_contract();
const Description<Responses>& responses_contract();
const Description<FrequencyTraces>& frequency_contract();
const Description<NonlinearFigures>& nonlinear_contract();
const Description<LinearisedResponse>& linear_contract();
const Description<IndexErrors>& index_errors_contract();
const Description<Verification>& verification_contract();

const Description<RegionFigures>& region_contract();

/// {"code", "detail"}.
const Description<Warning>& warning_contract();

}  // namespace tunewright::api
