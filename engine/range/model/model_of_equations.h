// The plant everywhere on a branch of steady states: its exact linearisation there.
#pragma once

#include <memory>

#include "engine/expected.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/model/range_model.h"

namespace tunewright::range {

/// Nothing is interpolated: every place has its own steady state. Points: five places evenly over the range. Warnings:
/// "input-folds" where the input turns back along the branch. Errors of `at`: those of SteadyBranch::at and
/// LinearPlant::make, with the place in the sentence.
Expected<std::shared_ptr<const RangeModel>> model_of_branch(std::shared_ptr<const SteadyBranch> branch);

}  // namespace tunewright::range
