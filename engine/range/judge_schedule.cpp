#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/range/design_range.h"
#include "engine/range/limit_remarks.h"
#include "engine/range/schedule/look.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {
namespace {

constexpr std::size_t kOwnPlaces = 9;  // with optima of their own; the worst places join them

}  // namespace

Expected<RangeDesign> judge_schedule(const RangeProblem& problem, const Schedule& schedule, const RunControl& control) {
    if (const auto faults = option_faults(problem.options); !faults.empty()) return faults.front();
    const RangeModel& model = *problem.model;
    auto rules = design_rules(model, problem.options);
    if (!rules) return rules.error();
    rules->integrated = !model.has_responses();
    Places places(model, problem.scheduling, *rules, control);
    auto own = OwnOptima::over(places, kOwnPlaces);
    if (!own) return own.error();

    // The curve's places are too few to see every limit exceeded; it has those where one is.
    const auto verified = verify(places, *own, schedule, std::log1p(problem.options.allowance));
    if (!verified) return verified.error();
    std::vector<double> extra = bends_of(model, schedule);
    extra.insert(extra.end(), verified->worst.begin(), verified->worst.end());
    const auto settings = [&schedule](double at) { return in_use(schedule, at); };
    auto curve = curve_over(places, *own, settings, kCurvePlaces, extra, problem.options.allowance);
    if (!curve) return curve.error();

    RangeDesign design;
    design.stated = model.stated();
    design.warnings = model.warnings();
    ScheduleDesign& given = design.schedule.emplace();
    given.schedule = schedule;
    const double excess = std::max(largest_excess(*curve), std::expm1(verified->excess));
    given.holds_limits = excess <= limits::kMaxRelativeExcessJudged;
    if (!given.holds_limits) design.warnings.push_back(schedule_above_limit(*curve, excess, places));
    given.worst_relative_IAE = largest_relative_IAE(*curve);
    given.within_allowance = given.worst_relative_IAE <= 1 + problem.options.allowance;
    const auto longest = longest_sample_time(model, schedule);
    if (!longest) return longest.error();
    given.longest_sample_time = *longest;
    design.schedule_curve = std::move(*curve);
    return design;
}

}  // namespace tunewright::range
