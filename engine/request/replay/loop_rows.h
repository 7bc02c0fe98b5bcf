// The record of a loop on rows of equal spacing, for a replay.
#pragma once

#include <optional>

#include "engine/identification/closed_loop/loop_record.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright {

inline constexpr int kMaxReplayRows = 20'000;
/// Fewer rows in automatic show the controller of an entry on its way from the recorded u, not the loop.
inline constexpr int kMinReplayRows = 50;

/// The rows at the usual spacing of the record; the last kMaxReplayRows if it has more. y is on straight lines between
/// its samples, u and r are held. Empty if a controller did not move u in all of them:
/// - with a column of the mode the longest stretch in automatic is taken, if it has kMinReplayRows;
/// - without one, if a controller was switched on in the record, if it has a part in manual (loop_parts.h), or if u
///   stands still against a tenth of the error.
std::optional<LoopRows> rows_in_automatic(const IdentifiedLoop& loop);

}  // namespace tunewright
