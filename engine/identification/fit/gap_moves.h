// Moves of u that happened while nothing was recorded.
#pragma once

#include <stop_token>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// Indices of the changes of u that were first seen after a spacing of more than 1.5 times the usual one: when they
/// happened in it is not recorded.
std::vector<int> gap_moves(const CleanRecord& record);

/// The record with each such change at the row, of those that are missing, at which this fit's structure and shape
/// explain y best: one after the other, until none moves.
CleanRecord with_gap_moves_placed(const CleanRecord& record, const Fit& fit, const std::vector<int>& moves,
                                  std::stop_token stop);

}  // namespace tunewright
