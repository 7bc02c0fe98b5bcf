// The plants at the points of a range, identified where a point has a record.
#pragma once

#include <vector>

#include "engine/request/range/ask_range.h"

namespace tunewright {

/// Records find their plants, and all of them one structure where their records allow it: of structures that differ,
/// the one in which all together lose least. `warnings` says which.
Expected<std::vector<RangePointPlant>> plants_of(const RangeQuestion& question, const RunControl& control,
                                                 std::vector<range::RangePoint>& points,
                                                 std::vector<Warning>& warnings);

}  // namespace tunewright
