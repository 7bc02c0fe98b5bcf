// Schedules that hold each row's settings over a part of the range.
#pragma once

#include "engine/expected.h"
#include "engine/range/schedule/design_schedule.h"

namespace tunewright::range {

/// Parts by OwnOptima::layout; each part's row is the one setting with the least worst price over the part and half the
/// hysteresis beyond it. The fewest rows that stay within the allowance, or `options.rows`; where 20 do not, those 20.
/// Errors: as design_schedule.
Expected<ScheduleDesign> steps_schedule(Places& places, OwnOptima& own, const RangeOptions& options);

}  // namespace tunewright::range
