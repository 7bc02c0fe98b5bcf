// Moves of u that happened while nothing was recorded: between which rows they are known, and where in between they
// explain y best.
#pragma once

#include <stop_token>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// Indices into record.v_time, ascending, of the changes of u that were first seen after a spacing of more than 1.5
/// times the usual one: the record does not show when they happened in it.
std::vector<int> gap_moves(const CleanRecord& record);

/// The record with each of the changes `moves` (from gap_moves()) at the missing row at which the structure and shape
/// of `fit` explain y best: one change after the other, until none moves, three rounds at most. A change is moved back
/// by whole usual spacings, eight at most, and never to or before the change of u before it.
///
/// Cost: one projection of the fit (output_error.h) for each row tried. When `stop` asks for it, the changes placed so
/// far keep their rows.
CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  const std::stop_token& stop);

}  // namespace tunewright
