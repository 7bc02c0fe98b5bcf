// The schedule with the fewest rows that keeps the limits everywhere and stays within the allowed cost.
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
    bool holds_limits = false;                       ///< at every evaluated point
    bool within_allowance = false;                   ///< IAE everywhere within the allowance over the point's own
                                                     ///< optimum
    double worst_relative_IAE = 0;                   ///< over all evaluated points
    std::optional<double> longest_sample_time = {};  ///< below
    bool partial = false;                            ///< stopped early
    std::vector<Warning> warnings;                   ///< "schedule-over-allowance"
};

/// OwnOptima::layout gives the rows' places. Their settings are designed together: all are unknowns of one search
/// (search_jointly) for the least worst cost over the range, with the limits kept at the rows and at three points of
/// every part. verify() checks the points between; the worst of them are added to the search, or the limits are
/// tightened by the excess, until no limit is exceeded by more than 2e-5 and the cost stays within the allowance. For
/// `steps` each part has one setting for its points and half the hysteresis beyond (steps_schedule).
///
/// Without `options.rows` the fewest rows, from 1 upwards; if no number of rows stays within the allowance, the nearest
/// to it: 20, or fewer if the search with 20 fails. The evaluated points are added to `own`.
///
/// `one`: the one setting for the range, if there is one. A search that fails from the own optima starts again from it;
/// if it keeps the limits everywhere and nothing better is found, it becomes the schedule, in `options.rows` equal rows
/// or else in one. Errors: those of PointDesigns::at; cancelled if it was stopped before anything was found.
Expected<ScheduleDesign> design_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                         const std::optional<IdealPid>& one);

/// The longest sample time of a program with backward rules that keeps Ms within 5 % of the continuous loop's, at the
/// model's points and at the rows, with each setting in use there, on the nominal plants. Empty: none was found, or the
/// plants are known by their frequency response alone. Errors: the model's.
Expected<std::optional<double>> longest_sample_time(const RangeModel& model, const Schedule& schedule,
                                                    const std::stop_token& stop = {});

/// Adds rows in the middles of the widest parts up to this number; the last part ends at `high`.
void fill_up(std::vector<double>& at, int rows, double high);

/// Adds the warning if the schedule exceeds the allowed cost.
void remark_cost(ScheduleDesign& design, double allowance);

}  // namespace tunewright::range
