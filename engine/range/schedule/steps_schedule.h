// A schedule of steps: one row for each part of the range, held until the next.
#pragma once

#include <optional>

#include "engine/range/schedule/design_schedule.h"

namespace tunewright::range {

/// Parts by OwnOptima::layout; each part's row is the one setting with the least worst cost over the part and half the
/// hysteresis beyond it. It has the fewest rows that stay within the allowance, or `options.rows`; 20 rows if even
/// these do not. Errors: as design_schedule.
Expected<ScheduleDesign> steps_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                        const std::optional<IdealPid>& one);

}  // namespace tunewright::range
