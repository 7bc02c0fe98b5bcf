// Experiments on the equations of a range: POST /v1/experiments/range.
#pragma once

#include <memory>
#include <vector>

#include "api/contract/range/range_request.h"
#include "api/contract/range/range_result.h"
#include "engine/range/experiments.h"

namespace tunewright::api {

/// Step and relay tests at several places of a range of equations: POST /v1/experiments/range.
struct RangeExperimentsRequest : RangeSubject {
    range::ExperimentOptions experiment;
};
const Description<RangeExperimentsRequest>& range_experiments_contract();

/// Tests at several places of a range.
struct RangeExperiments {
    std::shared_ptr<const range::SteadyBranch> branch;
    std::vector<range::PlaceTest> tests;
};
const Description<RangeExperiments>& range_experiments_answer_contract();

}  // namespace tunewright::api
