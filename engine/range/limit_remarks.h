// Warnings of settings and schedules that exceed a limit: which one, where, and by how much. Value and limit are
// written with as many digits as tell them apart, so that an excess of 1e-4 is seen.
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

/// On some plant of the curve by more than the plants between those of a design may.
inline bool exceeds_limit(const RangeCurve& curve) { return largest_excess(curve) > limits::kMaxRelativeExcessJudged; }

/// The one of Ms and Mt that comes nearest to its limit or lies farthest beyond it; null for a curve without places.
const WorstPoint* worst_limit(const RangeCurve& curve);

/// "limit-exceeded-between": one setting exceeds a limit between the points. Empty where it keeps them, but for 5e-5.
std::optional<Warning> one_above_limit(const RangeCurve& curve, const PointDesigns& places);

/// "schedule-above-limit". `excess`: the largest relative excess that is known, infinite for an unstable loop; it may
/// be of a place that the curve does not have.
Warning schedule_above_limit(const RangeCurve& curve, double excess, const PointDesigns& places);

}  // namespace tunewright::range
