// Step and relay tests at several places of a range of equations: POST /v1/experiments/range.
#pragma once

#include <memory>
#include <vector>

#include "api/contract/range/range_request.h"
#include "engine/range/experiments.h"

namespace tunewright::api {

struct RangeExperimentsRequest : RangeSubject {
    range::ExperimentOptions experiment;
};

struct RangeExperiments {
    std::shared_ptr<const range::SteadyBranch> branch;
    std::vector<range::PlaceTest> tests;
};

const Description<RangeExperimentsRequest>& range_experiments_contract();
const Description<RangeExperiments>& range_experiments_answer_contract();

}  // namespace tunewright::api
