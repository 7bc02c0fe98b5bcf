// The record of a loop on rows of equal spacing, for a replay.
#pragma once

#include "engine/expected.h"
#include "engine/identification/record/record.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright {

inline constexpr int kMaxReplayRows = 20'000;

/// The rows in order, without false readings (record/clean_record.h), at the usual spacing of the record, or
/// kMaxReplayRows rows if it has more: y on straight lines between its samples, u and r held. Errors: those of
/// clean_record(); invalid_argument for a record without a set point.
Expected<LoopRows> loop_rows(const Record& record);

}  // namespace tunewright
