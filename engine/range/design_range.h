// The entry: one setting and a schedule for an operating range, what each costs, and whether the schedule is worth it.
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
    bool hold_between = false;  ///< one setting keeps the limits between the points too: for models that are exact
};

/// Is a schedule worth it? By the largest IAE with one setting over that of the place's own optimum.
enum class Verdict {
    one_setting,  ///< not above 1 + allowance: a schedule would win nothing that is asked for
    optional,     ///< not above 1.3: a schedule wins what few loops need
    schedule,     ///< above 1.3, or no one setting keeps the limits
};

/// The border between `optional` and `schedule`.
constexpr double kMinCostRatioForSchedule = 1.3;

struct RangeDesign {
    std::optional<OneSetting> one;
    std::string why_no_one;  ///< the sentence, where there is none
    std::optional<ScheduleDesign> schedule;
    std::string why_no_schedule;
    RangeCurve one_curve, schedule_curve;  ///< without places where there is no such design
    Verdict verdict = Verdict::schedule;
    std::string because;  ///< the verdict as a sentence with its figures
    std::string stated;   ///< how the plants between the points are known
    std::vector<Warning> warnings;
    bool partial = false;  ///< stopped early: what was found by then
};

/// Every fault of the options, invalid_argument with `where` = "options/<field>": limits outside (1, 4] or m_circle,
/// allowance outside (0, 1], rows outside 1 to 20, b outside 0 to 1, hysteresis outside 0 to 0.2, P as a controller.
std::vector<Error> option_faults(const RangeOptions& options);

/// One setting, the schedule, their curves at 61 places and at points and rows, the same for both, the worst places and
/// the verdict. Where one setting stays
/// within the allowance everywhere and no number of rows is asked for, the schedule has that one row. Progress: stages
/// "tune", "schedule" and "evaluate", with the best so far.
///
/// Warnings: the model's; "limit-exceeded-between" where one setting exceeds a limit between the points;
/// "schedule-over-allowance"; "schedule-above-limit" where `holds_limits` is false. Errors: option_faults' first; those
/// of PointDesigns::at; where neither a setting nor a schedule exists, that of the setting; cancelled before anything
/// was found.
Expected<RangeDesign> design_range(const RangeProblem& problem, const RunControl& control);

/// Evaluates a given schedule over the range without a design: fast enough to follow a slider. Its cost is relative to
/// optima that are searched at a few places and interpolated between them; at the worst places, to their own optima.
/// `one` is empty and the verdict says nothing; a schedule beyond a limit has the warning "schedule-above-limit". Rows
/// ascend; hysteresis is in the unit of `at`.
///
/// Errors: option_faults' first; those of PointDesigns::at.
Expected<RangeDesign> judge_schedule(const RangeProblem& problem, const Schedule& schedule, const RunControl& control);

}  // namespace tunewright::range
