// The schedule with the fewest rows that keeps the limits everywhere and costs no more than is allowed.
#pragma once

#include <optional>
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
    bool holds_limits = false;                       ///< at every place that was looked at
    bool within_allowance = false;                   ///< IAE everywhere within the allowance of the place's own optimum
    double worst_relative_IAE = 0;                   ///< over all places that were looked at
    std::optional<double> longest_sample_time = {};  ///< below
    bool partial = false;                            ///< stopped early
    std::vector<Warning> warnings;                   ///< "schedule-over-allowance"
};

/// The rows' places are those of OwnOptima::layout. Their settings are designed together: all are unknowns of one
/// search (search_jointly) for the least of the worst cost over the range, the limits held at the rows and at three
/// places of every part, and verified between (verify()); the worst of the places met join the search, or the limits
/// are tightened by what is exceeded, until nothing exceeds a limit by more than 2e-5, or the allowance. Of `steps`
/// each part is one setting that serves its places and half the hysteresis beyond (steps_schedule).
///
/// Without `options.rows` the fewest rows, from 1 on; where no number of them stays within the allowance, those that
/// come nearest: 20, or fewer where 20 lead nowhere. `own` learns the places that are looked at.
///
/// `one`: the one setting for the range, where there is one. A search that leads nowhere from the own optima begins
/// again from it, and where it keeps the limits everywhere and nothing better is found, it is the schedule: in
/// `options.rows` equal rows, else in one.
/// Errors: those of PointDesigns::at; cancelled where nothing was found before the stop.
Expected<ScheduleDesign> design_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                         const std::optional<IdealPid>& one);

/// The longest sample time of a program with backward rules that keeps Ms within 5 % of the continuous loop's, at the
/// model's points and at the rows, with each setting in use there, on the nominal plants. Empty: none was found, or the
/// plants are known by their frequency response alone. Errors: the model's.
Expected<std::optional<double>> longest_sample_time(const RangeModel& model, const Schedule& schedule,
                                                    const std::stop_token& stop = {});

/// Rows in the middles of the widest parts, until there are so many; the last part ends at `high`.
void fill_up(std::vector<double>& at, int rows, double high);

/// The warning where the schedule costs more than is allowed.
void remark_cost(ScheduleDesign& design, double allowance);

}  // namespace tunewright::range
