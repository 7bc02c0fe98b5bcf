// False readings that only a model shows: those beside a step, which a neighbour's value cannot tell from a response.
// Those that no process makes are left out before (record_rows.h).
#pragma once

#include <cstddef>
#include <vector>

#include "engine/identification/fit/model_search.h"

namespace tunewright {

/// Indices, ascending, of the samples of a fitted record that may be false: up to three in a row that y jumps to and
/// back from, and single misses or pairs that are ten times as large as the median miss. Empty where they are more than
/// 1 % of all (and more than four). `fit` is of all samples of `record`.
std::vector<std::size_t> doubtful_samples(const CleanRecord& record, const Fit& fit);

/// Searches once more without the doubtful samples. The second search is returned, and the samples are noted in
/// `record`'s cleaning, where its model misses each of them by a twentieth of y's range and by eight times what it
/// misses of the others. Otherwise the first search is returned and the record stays: a process that does what the
/// samples show is followed by its model.
///
/// Records that were averaged over blocks, or searched in part, are returned as they are. When control.stop asks for
/// it, the first search is returned.
ModelSearch without_false_readings(ModelSearch search, CleanRecord& record, ModelChoice model,
                                   const RunControl& control);

}  // namespace tunewright
