#include "engine/range/schedule/design_schedule.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "engine/evaluation/longest_sample_time.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/range/limit_remarks.h"
#include "engine/range/schedule/knots.h"
#include "engine/range/schedule/point_evaluation.h"
#include "engine/range/schedule/steps_schedule.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {
namespace {

constexpr int kPointsInsidePart = 3;          // points inside a part that a search has from the beginning
constexpr double kAimedLogMargin = 3e-5;      // of ln of a limit: aimed at, so that points between keep it as well
constexpr double kLogCostReserve = 1e-3;      // of ln of the cost: reserve for points between the search's points
constexpr int kRounds = 8;                    // rounds in which exceeding points are added
constexpr double kMaxLayoutErrorShare = 0.6;  // share of ln of the allowed cost: with a larger error of the layout,
                                              // fewer rows are not tried
constexpr double kMinStepShare = 0.15;        // share of the distance to the allowed cost
constexpr double kMaxNearbyShare = 0.3;       // share of the distance between a search's points inside a part
constexpr int kIterations = 14;
constexpr int kNearestRows[] = {kMaxRows, 10, 5, 2};  // if no number of rows stays within the allowance

/// Compares by the limits first, then by the cost.
bool nearer(const ScheduleDesign& one, const std::optional<ScheduleDesign>& other) {
    if (!other || one.holds_limits != other->holds_limits) return !other || one.holds_limits;
    return one.worst_relative_IAE < other->worst_relative_IAE;
}

class LinearDesign {
public:
    LinearDesign(PointDesigns& places, OwnOptima& own, const RangeOptions& options, const std::optional<IdealPid>& one)
        : places_(places), own_(own), options_(options), one_(one), allowed_(std::log1p(options.allowance)) {}

    /// A schedule with this number of rows, from the own optima. Empty: the search ended without keeping the limits, or
    /// above the wanted cost. If it fails for the least cost, the search starts again from the one setting, which keeps
    /// the limits at least at the points; settings interpolated between few optima may not.
    Expected<std::optional<ScheduleDesign>> with(int rows, bool min_cost) {
        auto at = own_.layout(rows, options_.interpolation).at;
        if (min_cost) fill_up(at, rows, places_.model().high());
        Knots knots(places_, options_.interpolation, at);
        const auto known = places_of(at);
        if (!known) return known.error();
        for (PointDesign* place : *known)
            if (place->optimum_is_PI()) knots.leave_out_derivative(place->at());
        auto design = searched(knots, *known, knots.start(own_), min_cost);
        if (!design || !min_cost || !one_ || (*design && (*design)->holds_limits)) return design;
        if (!(one_->Td > 0))
            for (const double row : at) knots.leave_out_derivative(row);
        auto again = searched(knots, *known, knots.constant(point_of(*one_)), true);
        return !again || (*again && nearer(**again, *design)) ? again : design;
    }

private:
    Expected<std::optional<ScheduleDesign>> searched(const Knots& knots, const std::vector<PointDesign*>& known,
                                                     Eigen::VectorXd v, bool min_cost) {
        JointProblem joint = knots.problem();
        joint.places.assign(known.begin(), known.end());
        JointOptions search;
        search.max_iterations = kIterations;
        search.hopeless = min_cost ? 0 : kMinStepShare;
        search.margin = kAimedLogMargin;
        search.enough = min_cost ? -1 : allowed_ - kLogCostReserve;
        search.stop = places_.control().stop;
        std::optional<ScheduleDesign> best;
        for (int round = 0; round < kRounds; ++round) {
            const auto end = search_jointly(joint, v, search, {});
            v = end.v;
            if (!end.holds() || !std::isfinite(end.log_cost_ratio)) break;
            if (!min_cost && end.log_cost_ratio > allowed_) break;
            const Schedule schedule = knots.schedule(v, places_.rules(), options_.b);
            const auto verified =
                verify(places_, own_, schedule, min_cost ? end.log_cost_ratio + kLogCostReserve : allowed_);
            if (!verified) return verified.error();
            keep_better(best, schedule, *verified, end.stopped);
            const bool held = verified->excess <= limits::kMaxRelativeExcessVerified;
            const bool good = held && verified->worst.empty();
            if (end.stopped || (good && !add_worst_inside(schedule, joint.places))) return best;
            if (good) best.reset();  // plants inside a region were added, on which it exceeds a limit
            if (!held && verified->worst.empty()) search.margin += 1.2 * verified->excess;
            for (const double at : verified->worst) {
                const auto place = places_.at(at);
                if (!place) return place.error();
                (*place)->take_back_exceeded(point_of(settings_at(schedule, at)));
                if (std::ranges::find(joint.places, *place) == joint.places.end()) joint.places.push_back(*place);
            }
            own_.renew(places_);
        }
        return best;
    }

    /// The points of the rows, where the cost is largest, and some inside every part, where the limits are nearest;
    /// inside a part, known points nearby are used.
    Expected<std::vector<PointDesign*>> places_of(const std::vector<double>& rows) {
        std::vector<PointDesign*> result;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const auto row = places_.at(rows[k]);
            if (!row) return row.error();
            result.push_back(*row);
            if (k + 1 == rows.size()) break;
            const double width = (rows[k + 1] - rows[k]) / (kPointsInsidePart + 1);
            for (int i = 1; i <= kPointsInsidePart; ++i) {
                const double at = rows[k] + width * i;
                const auto inside = places_.at(near(at, kMaxNearbyShare * width).value_or(at));
                if (!inside) return inside.error();
                result.push_back(*inside);
            }
        }
        own_.renew(places_);
        return result;
    }

    /// At every point with a region of uncertainty: true if plants inside it were added on which the schedule exceeds a
    /// limit. The point is then added to the search.
    bool add_worst_inside(const Schedule& schedule, std::vector<const PointDesign*>& searched) {
        bool added = false;
        for (PointDesign* place : places_.known()) {
            if (!place->model().family) continue;
            const auto x = point_of(settings_at(schedule, place->at()));
            if (!place->add_worst_inside(x, places_.control().stop)) continue;
            added = true;
            if (std::ranges::find(searched, place) == searched.end()) searched.push_back(place);
        }
        return added;
    }

    std::optional<double> near(double at, double reach) const {
        for (const double known : own_.at())
            if (std::abs(known - at) < reach) return known;
        return std::nullopt;
    }

    void keep_better(std::optional<ScheduleDesign>& best, const Schedule& schedule, const Verified& verified,
                     bool stopped) const {
        ScheduleDesign design{.schedule = schedule,
                              .holds_limits = verified.excess <= limits::kMaxRelativeExcessVerified,
                              .within_allowance = verified.log_cost_ratio <= allowed_,
                              .worst_relative_IAE = std::exp(verified.log_cost_ratio),
                              .partial = stopped,
                              .warnings = {}};
        if (nearer(design, best)) best = design;
    }

    PointDesigns& places_;
    OwnOptima& own_;
    const RangeOptions& options_;
    const std::optional<IdealPid>& one_;
    double allowed_;
};

bool satisfies(const std::optional<ScheduleDesign>& design) {
    return design && design->holds_limits && design->within_allowance;
}

void report_progress(const PointDesigns& places, int rows) {
    const RunControl& control = places.control();
    if (!control.progress) return;
    control.progress(Progress{.fraction = std::min(0.9, 0.4 + 0.05 * rows),
                              .stage = "schedule",
                              .message = "schedule with " + std::to_string(rows) + " rows.",
                              .best = {}});
}

Error no_schedule(const PointDesigns& places) {
    return {places.control().stop.stop_requested() ? ErrorKind::cancelled : ErrorKind::numerical_failure, "",
            "No schedule was found whose limits hold between its rows. Narrow the range, or split it where its plants "
            "change most."};
}

/// The fewest rows within the allowance. Empty: none of the tried numbers of rows succeeded.
Expected<std::optional<ScheduleDesign>> fewest_rows(LinearDesign& linear, const PointDesigns& places,
                                                    const OwnOptima& own, const RangeOptions& options) {
    const double hopeless = kMaxLayoutErrorShare * std::log1p(options.allowance);
    std::optional<ScheduleDesign> best;
    for (int rows = 2; rows <= kMaxRows && !places.control().stop.stop_requested(); ++rows) {
        if (own.layout(rows, options.interpolation).error > hopeless) continue;
        report_progress(places, rows);
        auto design = linear.with(rows, false);
        if (!design || satisfies(*design)) return design;
        if (*design && nearer(**design, best)) best = **design;
    }
    return best;
}

/// The schedule nearest to the allowance: with the largest number of rows, or with fewer if that fails.
Expected<std::optional<ScheduleDesign>> nearest(LinearDesign& linear, const PointDesigns& places,
                                                std::optional<ScheduleDesign> best) {
    for (const int rows : kNearestRows) {
        if (places.control().stop.stop_requested()) break;
        report_progress(places, rows);
        auto design = linear.with(rows, true);
        if (!design) return design;
        if (*design && nearer(**design, best)) best = **design;
        if (best && best->holds_limits) break;
    }
    return best;
}

Expected<ScheduleDesign> linear_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                         const std::optional<IdealPid>& one) {
    LinearDesign linear(places, own, options, one);
    if (options.rows) report_progress(places, *options.rows);
    auto design =
        options.rows ? linear.with(std::max(2, *options.rows), true) : fewest_rows(linear, places, own, options);
    if (design && !options.rows && !satisfies(*design)) design = nearest(linear, places, std::move(*design));
    if (!design) return design.error();
    if (!*design) return no_schedule(places);
    return **design;
}

/// The one setting in as many rows as requested, else in one.
Expected<ScheduleDesign> same_everywhere(const PointDesigns& places, const OwnOptima& own, const RangeOptions& options,
                                         const IdealPid& one) {
    const double low = places.model().low(), width = places.model().high() - low;
    const int rows = options.rows.value_or(1);
    const bool steps = options.interpolation == Interpolation::steps || rows == 1;
    ScheduleDesign design{.schedule = {.interpolation = options.interpolation, .hysteresis = 0, .rows = {}},
                          .warnings = {}};
    if (options.interpolation == Interpolation::steps) design.schedule.hysteresis = options.hysteresis * width;
    for (int k = 0; k < rows; ++k)
        design.schedule.rows.push_back({.at = low + width * k / (steps ? rows : rows - 1),
                                        .Kp = one.Kp,
                                        .Ti = one.Ti,
                                        .Td = one.Td,
                                        .Tf = one.filter.Tf,
                                        .b = options.b});
    const double allowed = std::log1p(options.allowance);
    const auto verified = verify(places, own, design.schedule, allowed);
    if (!verified) return verified.error();
    design.holds_limits = verified->excess <= limits::kMaxRelativeExcessJudged;
    design.within_allowance = verified->log_cost_ratio <= allowed;
    design.worst_relative_IAE = std::exp(verified->log_cost_ratio);
    return design;
}

}  // namespace

void fill_up(std::vector<double>& at, int rows, double high) {
    while (int(at.size()) < rows) {
        const auto end = [&](std::size_t k) { return k + 1 < at.size() ? at[k + 1] : high; };
        std::size_t widest = 0;
        for (std::size_t k = 1; k < at.size(); ++k)
            if (end(k) - at[k] > end(widest) - at[widest]) widest = k;
        at.insert(at.begin() + std::ptrdiff_t(widest) + 1, 0.5 * (at[widest] + end(widest)));
    }
}

Expected<ScheduleDesign> design_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                         const std::optional<IdealPid>& one) {
    const bool one_row = options.rows && *options.rows == 1;
    const bool steps = options.interpolation == Interpolation::steps || one_row;
    auto design = steps ? steps_schedule(places, own, options, one) : linear_schedule(places, own, options, one);
    if ((design && satisfies(*design)) || !one || places.control().stop.stop_requested()) return design;
    auto same = same_everywhere(places, own, options, *one);
    return same && same->holds_limits && (!design || nearer(*same, *design)) ? same : design;
}

void remark_cost(ScheduleDesign& design, double allowance) {
    if (design.within_allowance) return;
    const double more = 100 * (design.worst_relative_IAE - 1), allowed = 100 * allowance;
    int digits = 3;
    while (digits < 9 && text(more, digits) == text(allowed, digits)) ++digits;
    design.warnings.push_back({"schedule-over-allowance",
                               "With " + std::to_string(design.schedule.rows.size()) + " rows the schedule has up to " +
                                   text(more, digits) + " % more IAE than the optimum at that point, but only " +
                                   text(allowed, 3) + " % is allowed. Allow more rows or a larger cost."});
}

namespace {

std::optional<double> longest_of(const LinearPlant& plant, const IdealPid& pid, const std::stop_token& stop) {
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    const Peak S = find_sensitivity_peak(*loop, make_peak_grid(*loop));
    if (!(S.omega > 0) || !std::isfinite(S.omega)) return std::nullopt;
    return tunewright::longest_sample_time(plant, to_parallel(pid), S.value, S.omega, kMsAsSampled, stop).value;
}

}  // namespace

Expected<std::optional<double>> longest_sample_time(const RangeModel& model, const Schedule& schedule,
                                                    const std::stop_token& stop) {
    std::vector<double> places = model.points();
    for (const ScheduleRow& row : schedule.rows)
        if (row.at > model.low() && row.at < model.high()) places.push_back(row.at);
    std::optional<double> min;
    for (const double at : places) {
        const auto place = model.at(at);
        if (!place) return place.error();
        if (!place->nominal) continue;
        for (const IdealPid& pid : in_use(schedule, at))
            if (const auto longest = longest_of(*place->nominal, pid, stop))
                min = std::min(min.value_or(*longest), *longest);
    }
    return min;
}

}  // namespace tunewright::range
