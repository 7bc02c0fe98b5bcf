// Warnings of settings and schedules that exceed a limit: which one, where, and by how much. Value and limit have as
// many digits as distinguish them, so that an excess of 1e-4 is visible.
//
//   if (exceeds_limit(curve))
//       warnings.push_back(schedule_above_limit(curve, largest_excess(curve), places));
#pragma once

#include <optional>

#include "engine/range/curves.h"
#include "engine/range/search/point_designs.h"
#include "engine/tuning/limits.h"
#include "engine/warning.h"

namespace tunewright::range {

/// True if some plant of the curve exceeds a limit by more than is tolerated between the points of a design.
inline bool exceeds_limit(const RangeCurve& curve) { return largest_excess(curve) > limits::kMaxRelativeExcessJudged; }

/// The peak (Ms or Mt) that comes nearest to its limit or exceeds it most; null for a curve without points.
const WorstPoint* worst_limit(const RangeCurve& curve);

/// "limit-exceeded-between": one setting exceeds a limit between the points. Empty if it keeps them, apart from 5e-5.
std::optional<Warning> one_above_limit(const RangeCurve& curve, const PointDesigns& places);

/// "schedule-above-limit". `excess`: the largest known relative excess, infinite for an unstable loop; it may belong to
/// a point that the curve does not have.
Warning schedule_above_limit(const RangeCurve& curve, double excess, const PointDesigns& places);

}  // namespace tunewright::range
