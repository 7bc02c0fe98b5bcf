// The schedule with the fewest rows that keeps the limits everywhere and costs no more than is allowed.
#pragma once

#include <string>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/expected.h"
#include "engine/range/one_setting.h"
#include "engine/range/schedule/own_optima.h"
#include "engine/warning.h"

namespace tunewright::range {

struct ScheduleDesign {
    Schedule schedule;
    bool holds_limits = false;      ///< at every place that was looked at
    bool within_allowance = false;  ///< IAE everywhere within the allowance of the place's own optimum
    double worst_relative_IAE = 0;  ///< over all places that were looked at
    bool partial = false;           ///< stopped early
    std::vector<Warning> warnings;  ///< "schedule-over-allowance"
};

/// The rows' places are those of OwnOptima::layout. Their settings are designed together: all are unknowns of one
/// search (search_jointly) for the least of the worst price over the range, the limits held at the rows and at three
/// places of every part, and verified between (verify()); the worst of the places met join the search, or the limits
/// are tightened by what is exceeded, until nothing exceeds a limit by more than 2e-5, or the allowance. Of `steps`
/// each part is one setting that serves its places and half the hysteresis beyond (steps_schedule).
///
/// Without `options.rows` the fewest rows, from 1 on; where even 20 do not stay within the allowance, those that come
/// nearest, with a warning. `own` learns the places that are looked at.
/// Errors: those of Places::at; cancelled where nothing was found before the stop.
Expected<ScheduleDesign> design_schedule(Places& places, OwnOptima& own, const RangeOptions& options);

/// Parts by OwnOptima::layout; each part's row is the one setting with the least worst price over the part and half the
/// hysteresis beyond it. The fewest rows that stay within the allowance, or `options.rows`; where 20 do not, those 20.
/// Errors: as design_schedule.
Expected<ScheduleDesign> steps_schedule(Places& places, OwnOptima& own, const RangeOptions& options);

}  // namespace tunewright::range
