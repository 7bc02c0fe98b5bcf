// The record of a loop on rows of equal spacing, for a replay.
#pragma once

#include "engine/expected.h"
#include "engine/identification/record/record.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright {

inline constexpr int kMaxReplayRows = 20'000;

struct RecordedLoop {
    LoopRows rows;
    bool manual = false;  ///< a controller was switched on in the record, or it has a part in manual
};

/// The rows in order, without false readings (record/clean_record.h), at the usual spacing of the record; the last
/// kMaxReplayRows if it has more. y is on straight lines between its samples, u and r are held. Errors: those of
/// clean_record(); invalid_argument for a record whose column r is missing or is no set point.
Expected<RecordedLoop> recorded_loop(const Record& record);

}  // namespace tunewright
