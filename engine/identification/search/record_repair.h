// Repairs of a record that need a model: false readings next to a step, which neighbouring values cannot distinguish
// from a response (physically impossible ones are removed before, record_rows.h), and moves of u while nothing was
// recorded.
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/identification/fit/output_error.h"
#include "engine/identification/search/model_search.h"

namespace tunewright {

/// Indices, ascending, of the samples of a fitted record that may be false: up to three in a row to which y jumps and
/// from which it jumps back, and single residuals or pairs that are ten times as large as the median residual. Empty if
/// they are more than 1 % of all (and more than four). `fit` must be of all samples of `record`.
std::vector<std::size_t> doubtful_samples(const CleanRecord& record, const Fit& fit);

/// Searches again without the doubtful samples. The second search is returned, and the samples are recorded in the
/// cleaning of `record`, if its model differs from each of them by a twentieth of y's range and by eight times its
/// residual elsewhere. Otherwise the first search is returned and the record is not changed: if the samples are real,
/// the model follows them.
///
/// Records that were averaged over blocks, or searched in part, are returned as they are. After a stop request the
/// first search is returned.
ModelSearch without_false_readings(ModelSearch search, CleanRecord& record, ModelChoice model,
                                   const RunControl& control);

/// The time of the last row before the one at or after `time`; `time` itself if that row is the first.
double row_before(const CleanRecord& record, double time);

/// Indices into record.v_time, ascending, of the changes of u that were first seen after a spacing of more than 1.5
/// times the usual one: the record does not show when they happened in it.
std::vector<int> gap_moves(const CleanRecord& record);

/// For a record in which every change of u first shows after missing rows: the dead time then includes the missing
/// time, however well the model fits. Returns the record with each change in the middle of its missing rows, and with
/// `moves_unseen`, the shortest such interval. Empty if one change is recorded, if no interval is two usual spacings
/// long, or if rows are not evenly spaced, or not before each interval: then the recorder may have waited for the
/// change.
std::optional<CleanRecord> with_unseen_moves(const CleanRecord& record);

/// The record with each of the changes `moves` (from gap_moves()) at the missing row with which the structure and shape
/// of `fit` explain y best: one change after the other, until none moves, at most three rounds. A change is moved back
/// by whole usual spacings, eight at most, and never to or before the change of u before it.
///
/// Cost: one projection of the fit (output_error.h) for each tried row. After a stop request the changes placed so far
/// keep their rows.
CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  const std::stop_token& stop);

/// The same for every change of u, within the row that shows it and in steps of a fifth of it: a relay that samples
/// more often than the recorder switches between the rows.
CleanRecord with_switches_placed(const CleanRecord& record, const Fit& fit, const std::stop_token& stop);

}  // namespace tunewright
