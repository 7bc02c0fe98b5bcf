// False readings that only a model shows: those beside a step, which a neighbour's value cannot tell from a response.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/identification/fit/model_search.h"

namespace tunewright {

/// Samples of a fitted record that may be false: up to three in a row that y jumps to and back from, and single misses
/// or pairs ten times as large as the median miss; none where they are more than 1 % (or 4) of all.
std::vector<std::size_t> doubtful_samples(const CleanRecord& record, const Fit& fit);

/// The search once more without the doubtful samples. Kept, with them noted in `record`'s cleaning, where the models
/// found without them miss each of them by a twentieth of y's range and eight times what they miss of the others; a
/// process that does what the samples show is followed by its model.
ModelSearch without_false_readings(ModelSearch search, CleanRecord& record, ModelChoice model,
                                   const RunControl& control);

}  // namespace tunewright
