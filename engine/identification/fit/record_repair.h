// What only a model shows of a record, and the record put right by it: false readings beside a step, which a
// neighbour's value cannot tell from a response (those that no process makes are left out before, record_rows.h), and
// moves of u that happened while nothing was recorded.
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/identification/fit/model_search.h"
#include "engine/identification/fit/output_error.h"

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

/// The time of the last row before the one at or after `time`; `time` itself where that is the first.
double row_before(const CleanRecord& record, double time);

/// Indices into record.v_time, ascending, of the changes of u that were first seen after a spacing of more than 1.5
/// times the usual one: the record does not show when they happened in it.
std::vector<int> gap_moves(const CleanRecord& record);

/// Where every change of u was first seen after missing rows, the dead time takes up what they hide, however well the
/// model then fits: the record with each change in the middle of the rows at which it may have happened, and with
/// `moves_unseen`, the shortest such stretch. Empty where one change is recorded, where no stretch is two usual
/// spacings long, and where rows are not evenly spaced, or not before each stretch: what wrote them may have waited for
/// the change.
std::optional<CleanRecord> with_unseen_moves(const CleanRecord& record);

/// The record with each of the changes `moves` (from gap_moves()) at the missing row at which the structure and shape
/// of `fit` explain y best: one change after the other, until none moves, three rounds at most. A change is moved back
/// by whole usual spacings, eight at most, and never to or before the change of u before it.
///
/// Cost: one projection of the fit (output_error.h) for each row tried. When `stop` asks for it, the changes placed so
/// far keep their rows.
CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  const std::stop_token& stop);

/// The same of every change of u, within the row that shows it and in steps of a fifth of it: a relay that looks
/// oftener than it is recorded switches between the rows.
CleanRecord with_switches_placed(const CleanRecord& record, const Fit& fit, const std::stop_token& stop);

}  // namespace tunewright
