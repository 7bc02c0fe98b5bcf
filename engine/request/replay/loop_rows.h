// A loop's record on rows of equal spacing, as a replay takes it.
#pragma once

#include "engine/expected.h"
#include "engine/identification/record/record.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright {

inline constexpr int kMaxReplayRows = 20'000;

/// The rows in order, false readings left out (record/clean_record.h), at the record's usual spacing or, where these
/// were more than kMaxReplayRows, at so many: y on straight lines between its samples, u and r held. Errors: those of
/// clean_record(); invalid_argument for a record without a set point.
Expected<LoopRows> loop_rows(const Record& record);

}  // namespace tunewright
