// Moves of u that the rows of a recorder show late: how late, is the dead time's doubt.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// The record with each change of u midway between the row that shows it and the row before: what a logger that writes
/// now and then, at uneven times, has seen late. RecordFacts::moved_between_rows is then set; moves with the first row
/// stay.
CleanRecord changed_between_rows(CleanRecord record);

/// Somebody moves u at any instant, and the next row shows it: up to a row late, and the dead time of `fit` comes out
/// too short by as much. Where a row is more than half of it (half of the lags but the slowest act as dead time too),
/// the record with `moved_within`, the stretch that remains open:
/// - a lone move stays where the rows show it, as a program that moves u with a row has it; it may have been a row
///   earlier, and that row to either side is open;
/// - two to five moves that y shows to lie differently in their rows are put apart as y shows it; open is what is left
///   of a row. Where y shows that all fall on rows, the recorder moved u itself, and nothing is open (empty). Where y
///   does not tell, each is treated as a lone one.
///
/// Empty also where rows are not evenly spaced or were averaged, where moves have been put elsewhere already, and where
/// one comes with the first row, in a gap, within three rows of another, or as the sixth. `fit` is of the record's
/// samples. Cost: some tens of fits where there are several moves.
std::optional<CleanRecord> with_moves_between_rows(const CleanRecord& record, const Fit& fit,
                                                   const std::stop_token& stop);

}  // namespace tunewright
