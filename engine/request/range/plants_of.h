// The plants at the points of a range, identified where a point has a record.
#pragma once

#include <vector>

#include "engine/request/range/ask_range.h"

namespace tunewright {

/// Identifies the records, in one structure for all of them if their data allow it: if the structures differ, the one
/// with the least total loss. `warnings` names it.
Expected<std::vector<RangePointPlant>> plants_of(const RangeQuestion& question, const RunControl& control,
                                                 std::vector<range::RangePoint>& points,
                                                 std::vector<Warning>& warnings);

}  // namespace tunewright
