// The main entry point: designs one setting and a schedule for an operating range, with the cost of each, and decides
// whether the schedule is worthwhile.
//
//   const auto model = model_of_points(points, Between::parameters);
//   const auto design = design_range({.scheduling = {"load", "%"}, .model = *model, .options = {}}, control);
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/range/curves.h"
#include "engine/range/model/range_model.h"
#include "engine/range/one_setting.h"
#include "engine/range/problem.h"
#include "engine/range/schedule/design_schedule.h"
#include "engine/warning.h"

namespace tunewright::range {

struct RangeProblem {
    Scheduling scheduling;
    std::shared_ptr<const RangeModel> model;  ///< model_of_points, model_of_branch
    RangeOptions options;
    bool hold_between = false;  ///< one setting keeps the limits between the points too: for exact models
};

/// The verdict on a schedule, by the largest ratio of the IAE with one setting to that of the point's own optimum.
enum class Verdict {
    one_setting,  ///< at most 1 + allowance: a schedule has no advantage
    optional,     ///< at most 1.3: a schedule has an advantage that few loops need
    schedule,     ///< above 1.3, or no single setting keeps the limits
};

/// The threshold between `optional` and `schedule`.
constexpr double kMinCostRatioForSchedule = 1.3;

struct RangeDesign {
    std::optional<OneSetting> one;
    std::string why_no_one;  ///< the reason, as a sentence, if there is no such setting
    std::optional<ScheduleDesign> schedule;
    std::string why_no_schedule;
    RangeCurve one_curve, schedule_curve;  ///< without points if there is no such design
    Verdict verdict = Verdict::schedule;
    std::string because;  ///< the verdict as a sentence with its figures
    std::string stated;   ///< the model of the plants between the points, as a sentence
    std::vector<Warning> warnings;
    bool partial = false;  ///< stopped early, with the results so far
};

/// All errors of the options, invalid_argument with `where` = "options/<field>": limits outside (1, 4] or m_circle,
/// allowance outside (0, 1], rows outside 1 to 20, b outside 0 to 1, hysteresis outside 0 to 0.2, P as a controller.
std::vector<Error> option_faults(const RangeOptions& options);

/// Designs one setting and the schedule, with their curves (at 61 evenly spaced points and at all points and rows, the
/// same for both), the worst points and the verdict. If one setting stays within the allowance everywhere and no number
/// of rows is requested, the schedule consists of that one row. Progress: stages "tune", "schedule" and "evaluate",
/// with the best so far.
///
/// Warnings: the model's; "limit-exceeded-between" if one setting exceeds a limit between the points;
/// "schedule-over-allowance"; "schedule-above-limit" if `holds_limits` is false. Errors: the first of option_faults;
/// those of PointDesigns::at; if there is neither a setting nor a schedule, that of the setting; cancelled if it was
/// stopped before anything was found.
Expected<RangeDesign> design_range(const RangeProblem& problem, const RunControl& control);

/// Evaluates a given schedule over the range without a design: fast enough to follow a slider. Its cost is relative to
/// optima that are searched at a few places and interpolated between them; at the worst places, to their own optima.
/// `one` and `because` are empty, and `verdict` has no meaning; a schedule beyond a limit has the warning
/// "schedule-above-limit". Rows ascend; hysteresis is in the unit of `at`.
///
/// Errors: the first of option_faults; those of PointDesigns::at.
Expected<RangeDesign> judge_schedule(const RangeProblem& problem, const Schedule& schedule, const RunControl& control);

}  // namespace tunewright::range
