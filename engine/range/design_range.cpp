#include "engine/range/design_range.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/best_so_far.h"
#include "engine/number_text.h"
#include "engine/range/limit_remarks.h"
#include "engine/range/schedule/point_evaluation.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {
namespace {

constexpr int kMaxPointsAdded = 6;  // points that are added so that one setting holds between the points

SettingsInUse always(const IdealPid& controller) {
    return [controller](double) { return std::vector<IdealPid>{controller}; };
}

DesignRules with_integrated_error(DesignRules rules) {
    rules.integrated = true;
    return rules;
}

class RangeWork {
public:
    RangeWork(const RangeProblem& problem, const DesignRules& rules, const RunControl& control)
        : problem_(problem),
          options_(problem.options),
          points_(*problem.model, problem.scheduling, rules, control),
          integrated_(*problem.model, problem.scheduling, with_integrated_error(rules), control),
          places_(problem.model->has_responses() ? points_ : integrated_),
          control_(control) {}

    Expected<RangeDesign> run() {
        design_.stated = problem_.model->stated();
        design_.warnings = problem_.model->warnings();
        for (const double at : problem_.model->points())
            if (const auto place = points_.at_point(at); !place) return place.error();
        if (auto error = find_one()) return *error;
        if (auto error = find_schedule()) return *error;
        judge();
        report_progress(1, "evaluate", "the range is designed.");
        return std::move(design_);
    }

private:
    bool stopped() const { return control_.stop.stop_requested(); }

    void report_progress(double fraction, const char* stage, std::string message) const {
        if (!control_.progress) return;
        Progress progress{.fraction = fraction, .stage = stage, .message = std::move(message), .best = {}};
        if (design_.one)
            progress.best = std::make_shared<const BestSoFar>(BestSoFar{
                design_.one->controller, design_.one->worst_relative_IAE, options_.limits.Ms, options_.limits.Mt});
        control_.progress(progress);
    }

    /// No error if it was a stop, which keeps the results so far; any other error ends the work.
    std::optional<Error> unless_stopped(const Error& error) {
        if (error.kind != ErrorKind::cancelled || !design_.one) return error;
        design_.partial = true;
        return std::nullopt;
    }

    std::optional<Error> find_one() {
        std::vector<double> points = problem_.model->points();
        auto one = design_one_setting(points_, points, options_);
        auto own = OwnOptima::over(places_);
        if (one) design_.one = *one;
        if (!one && (one.error().kind == ErrorKind::cancelled || one.error().kind == ErrorKind::numerical_failure))
            return one.error();
        if (!own) return unless_stopped(own.error());
        own_ = *own;
        for (int round = 0; one && round <= kMaxPointsAdded; ++round) {
            auto curve = curve_over(places_, own_, always(one->controller), kCurvePoints, points, options_.allowance);
            if (!curve) return unless_stopped(curve.error());
            design_.one = *one;
            design_.one_curve = std::move(*curve);
            const WorstPoint* worst = worst_limit(design_.one_curve);
            if (!problem_.hold_between || !exceeds_limit(design_.one_curve) || one->partial) break;
            points.push_back(worst->at);
            std::ranges::sort(points);
            one = design_one_setting(points_, points, options_);
        }
        if (!one) {
            design_.one.reset();
            design_.one_curve = {};
            design_.why_no_one = one.error().message;
            no_one_ = one.error();
        }
        report_progress(0.4, "tune", "one setting for the range.");
        warn_between();
        return std::nullopt;
    }

    void warn_between() {
        if (!design_.one || design_.one_curve.places.empty()) return;
        if (auto warning = one_above_limit(design_.one_curve, places_)) design_.warnings.push_back(*warning);
    }

    bool one_is_enough() const {
        return design_.one && !design_.one_curve.places.empty() && !options_.rows &&
               largest_relative_IAE(design_.one_curve) <= 1 + options_.allowance && !exceeds_limit(design_.one_curve);
    }

    std::optional<Error> find_schedule() {
        if (auto error = search_schedule()) return error;
        if (!design_.schedule) return std::nullopt;
        const auto longest = longest_sample_time(*problem_.model, design_.schedule->schedule);
        if (!longest) return longest.error();
        design_.schedule->longest_sample_time = *longest;
        return std::nullopt;
    }

    std::optional<Error> search_schedule() {
        if (design_.partial || (stopped() && design_.one)) {
            design_.partial = true;
            design_.why_no_schedule = "The design was stopped before the search for a schedule.";
            return std::nullopt;
        }
        if (one_is_enough()) {
            design_.schedule = of_one_row();
            design_.schedule_curve = design_.one_curve;
            return std::nullopt;
        }
        auto schedule = design_schedule(places_, own_, options_, one_controller());
        if (!schedule) {
            if (!design_.one) return no_one_;
            design_.partial = schedule.error().kind == ErrorKind::cancelled;
            design_.why_no_schedule = schedule.error().message;
            return std::nullopt;
        }
        report_progress(0.9, "schedule", "a schedule of " + std::to_string(schedule->schedule.rows.size()) + " rows.");
        return take(std::move(*schedule));
    }

    std::optional<IdealPid> one_controller() const {
        return design_.one ? std::optional(design_.one->controller) : std::nullopt;
    }

    std::optional<Error> take(ScheduleDesign schedule) {
        const auto in_use_at = [&](double at) { return in_use(schedule.schedule, at); };
        std::vector<double> extra = bends_of(*problem_.model, schedule.schedule);
        for (const PointFigures& place : design_.one_curve.places) extra.push_back(place.at);
        auto curve = curve_over(places_, own_, in_use_at, kCurvePoints, extra, options_.allowance);
        design_.partial = design_.partial || schedule.partial;
        if (curve) {
            schedule.worst_relative_IAE = std::max(schedule.worst_relative_IAE, largest_relative_IAE(*curve));
            schedule.holds_limits = schedule.holds_limits && !exceeds_limit(*curve);
            if (!schedule.holds_limits) {
                const auto verified = verify(places_, own_, schedule.schedule, std::log1p(options_.allowance));
                const double excess = verified ? std::expm1(verified->excess) : -1;
                schedule.warnings.push_back(
                    schedule_above_limit(*curve, std::max(largest_excess(*curve), excess), places_));
            }
        }
        remark_cost(schedule, options_.allowance);
        design_.warnings.insert(design_.warnings.end(), schedule.warnings.begin(), schedule.warnings.end());
        if (!curve) {
            design_.schedule = std::move(schedule);
            return unless_stopped(curve.error());
        }
        // Both curves have the same points, so that they can be drawn and compared.
        if (design_.one && !design_.one_curve.places.empty())
            if (auto error = add_places(design_.one_curve, places_, own_, always(design_.one->controller), extra))
                return error;
        design_.schedule_curve = std::move(*curve);
        design_.schedule = std::move(schedule);
        return std::nullopt;
    }

    ScheduleDesign of_one_row() const {
        const IdealPid& pid = design_.one->controller;
        ScheduleDesign design{.schedule = {.interpolation = options_.interpolation, .hysteresis = 0, .rows = {}},
                              .holds_limits = true,
                              .within_allowance = true,
                              .worst_relative_IAE = largest_relative_IAE(design_.one_curve),
                              .partial = false,
                              .warnings = {}};
        design.schedule.rows = {
            {.at = problem_.model->low(), .Kp = pid.Kp, .Ti = pid.Ti, .Td = pid.Td, .Tf = pid.filter.Tf, .b = pid.b}};
        return design;
    }

    void judge() {
        const std::string rule = " (a schedule is worthwhile above " + text(kMinCostRatioForSchedule) + " times).";
        if (!design_.one) {
            design_.verdict = Verdict::schedule;
            design_.because = "No single setting keeps the limits over the range, so it needs a schedule.";
            return;
        }
        const double one = design_.one_curve.places.empty() ? design_.one->worst_relative_IAE
                                                            : largest_relative_IAE(design_.one_curve);
        const std::string cost =
            std::isfinite(one) ? "costs up to " + text(one, 3) + " times" : "has no finite part of";
        if (one <= 1 + options_.allowance) {
            design_.verdict = Verdict::one_setting;
            design_.because = "One setting is enough: its IAE is at most " + text(one, 3) +
                              " times that of the optimum at each point" + rule;
            return;
        }
        design_.verdict = one <= kMinCostRatioForSchedule ? Verdict::optional : Verdict::schedule;
        design_.because =
            "One setting " + cost + " the IAE of the optimum at that point" +
            (design_.schedule ? ", a schedule of " + std::to_string(design_.schedule->schedule.rows.size()) +
                                    " rows up to " + text(design_.schedule->worst_relative_IAE, 3) + " times"
                              : std::string()) +
            rule;
    }

    const RangeProblem& problem_;
    const RangeOptions& options_;
    PointDesigns points_, integrated_;
    PointDesigns& places_;  ///< the rows of the schedule and the points of the curves
    const RunControl& control_;
    OwnOptima own_;
    RangeDesign design_;
    Error no_one_;
};

}  // namespace

std::vector<Error> option_faults(const RangeOptions& options) {
    std::vector<Error> faults;
    const auto check = [&](bool good, const std::string& field, const std::string& message) {
        if (!good) faults.push_back({ErrorKind::invalid_argument, "options/" + field, message});
    };
    const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
    check(options.controller != ControllerKind::P, "controller",
          "A P controller has no integral action; use PI or PID.");
    check(options.limits.Ms > 1 && options.limits.Ms <= 4, "Ms",
          "Ms is " + text(options.limits.Ms) + "; must be above 1 and at most 4.");
    check(options.limits.Mt > 1 && options.limits.Mt <= 4, "Mt",
          "Mt is " + text(options.limits.Mt) + "; must be above 1 and at most 4.");
    check(!options.limits.m_circle, "constraint", "A range is designed under limits on Ms and Mt; omit m_circle.");
    check(options.allowance > 0 && options.allowance <= 1, "allowance",
          "allowance is " + text(options.allowance) + "; must be above 0 and at most 1.");
    check(within(options.b, 0, 1), "b", "b is " + text(options.b) + "; must be 0 to 1.");
    check(within(options.hysteresis, 0, 0.2), "hysteresis",
          "hysteresis is " + text(options.hysteresis) + " of the range; must be 0 to 0.2.");
    check(!options.rows || within(*options.rows, 1, kMaxRows), "rows",
          "rows is " + std::to_string(options.rows.value_or(0)) + "; must be 1 to 20.");
    return faults;
}

Expected<RangeDesign> design_range(const RangeProblem& problem, const RunControl& control) {
    const auto faults = option_faults(problem.options);
    if (!faults.empty()) return faults.front();
    const auto rules = design_rules(*problem.model, problem.options);
    if (!rules) return rules.error();
    return RangeWork(problem, *rules, control).run();
}

namespace {

constexpr std::size_t kOptimumPoints = 9;  // points with optima of their own; the worst points are added to them

}  // namespace

Expected<RangeDesign> judge_schedule(const RangeProblem& problem, const Schedule& schedule, const RunControl& control) {
    if (const auto faults = option_faults(problem.options); !faults.empty()) return faults.front();
    const RangeModel& model = *problem.model;
    auto rules = design_rules(model, problem.options);
    if (!rules) return rules.error();
    rules->integrated = !model.has_responses();
    PointDesigns places(model, problem.scheduling, *rules, control);
    auto own = OwnOptima::over(places, kOptimumPoints);
    if (!own) return own.error();

    // The curve has too few points to show every exceeded limit; points that exceed one are added to it.
    const auto verified = verify(places, *own, schedule, std::log1p(problem.options.allowance));
    if (!verified) return verified.error();
    std::vector<double> extra = bends_of(model, schedule);
    extra.insert(extra.end(), verified->worst.begin(), verified->worst.end());
    const auto settings = [&schedule](double at) { return in_use(schedule, at); };
    auto curve = curve_over(places, *own, settings, kCurvePoints, extra, problem.options.allowance);
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
