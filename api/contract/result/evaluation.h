// The evaluation of one controller on one plant, as answers carry it.
#pragma once

#include "api/describe/description.h"
#include "engine/evaluation/evaluation.h"

namespace tunewright::api {

// Figures of the loop. A figure without a value is null, with the reason under its name in `why_null`.
const Description<Robustness>& robustness_contract();
const Description<Performance>& performance_contract();
const Description<LoadPerformance>& load_contract();
/// Figures of a controller of the form npid.
const Description<NonlinearFigures>& nonlinear_contract();
/// Figures of a nonlinear plant's linearisation, next to those of the plant itself.
const Description<LinearisedResponse>& linear_contract();
/// The worst figures over the plants that the controller must serve.
const Description<RegionFigures>& region_contract();

// Traces for plots, with six significant digits.
const Description<Responses>& responses_contract();
const Description<FrequencyTraces>& frequency_contract();

// The estimated errors of the figures.
const Description<IndexErrors>& index_errors_contract();
const Description<Verification>& verification_contract();

/// {"code", "detail"}.
const Description<Warning>& warning_contract();

}  // namespace tunewright::api
