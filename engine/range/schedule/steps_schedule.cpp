#include "engine/range/schedule/steps_schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/range/one_setting_problem.h"
#include "engine/range/schedule/point_evaluation.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {
namespace {

constexpr double kStepsLogMargin = 3e-5;  // margin to ln of a limit, so that operating points in between also keep the
                                          // limit
constexpr int kMaxStepsRounds = 4;        // each with tighter limits
constexpr int kMinPointsOfPart = 3;       // operating points in each part of the schedule, ends included

class StepsDesign {
public:
    StepsDesign(PointDesigns& places, OwnOptima& own, const RangeOptions& options, const std::optional<IdealPid>& one)
        : places_(places),
          own_(own),
          options_(options),
          one_(one),
          low_(places.model().low()),
          high_(places.model().high()),
          hysteresis_(options.hysteresis * (high_ - low_)) {}

    Expected<std::optional<ScheduleDesign>> with(int rows) {
        auto layout = own_.layout(rows, Interpolation::steps).at;
        if (options_.rows) fill_up(layout, rows, high_);
        std::optional<ScheduleDesign> best;
        for (int round = 0; round < kMaxStepsRounds; ++round) {
            ScheduleDesign design{
                .schedule = {.interpolation = Interpolation::steps, .hysteresis = hysteresis_, .rows = {}},
                .warnings = {}};
            for (std::size_t k = 0; k < layout.size(); ++k) {
                const auto row = serve(layout[k], k + 1 < layout.size() ? layout[k + 1] : high_);
                if (!row) return row.error();
                if (!*row) return best;
                design.schedule.rows.push_back(**row);
            }
            own_.renew(places_);
            const auto verified = verify(places_, own_, design.schedule, std::log1p(options_.allowance));
            if (!verified) return verified.error();
            design.holds_limits = verified->excess <= limits::kMaxRelativeExcessVerified;
            design.worst_relative_IAE = std::exp(verified->log_cost_ratio);
            design.within_allowance = design.worst_relative_IAE <= 1 + options_.allowance;
            design.partial = places_.control().stop.stop_requested();
            if (!best || design.holds_limits || !best->holds_limits) best = design;
            if (design.holds_limits || design.partial) break;
            const bool joined = take_back_exceeded(design.schedule);
            if (!joined && !std::isfinite(verified->excess)) break;
            if (!joined) margin_ += 1.2 * verified->excess;
        }
        return best;
    }

private:
    /// The points of a part, with the hysteresis beyond its ends.
    Expected<std::vector<PointDesign*>> places_of(double from, double to) {
        const double begin = std::max(low_, from - 0.5 * hysteresis_), end = std::min(high_, to + 0.5 * hysteresis_);
        for (int i = 0; i < kMinPointsOfPart; ++i) {
            const double at = i + 1 == kMinPointsOfPart ? end : begin + (end - begin) * i / (kMinPointsOfPart - 1);
            if (const auto place = places_.at(at); !place) return place.error();
        }
        std::vector<PointDesign*> inside;
        for (PointDesign* place : places_.known())
            if (place->at() >= begin && place->at() <= end) inside.push_back(place);
        return inside;
    }

    /// True if plants that the searches had set aside were added again, because a setting in use at their point exceeds
    /// a limit on them.
    bool take_back_exceeded(const Schedule& schedule) {
        bool added = false;
        for (PointDesign* place : places_.known())
            for (const IdealPid& pid : in_use(schedule, place->at()))
                added = place->take_back_exceeded(point_of(pid)) || added;
        return added;
    }

    /// Empty: no setting was found that keeps the limits.
    Expected<std::optional<ScheduleRow>> serve(double from, double to) {
        const auto inside = places_of(from, to);
        if (!inside) return inside.error();
        std::optional<IdealPid> best;
        double min = std::numeric_limits<double>::infinity();
        const auto consider = [&](const robust::DesignPoint& start, bool PI) {
            const JointProblem joint = one_setting_problem(*inside, options_, PI);
            JointOptions search;
            search.margin = margin_;
            search.stop = places_.control().stop;
            const auto end = search_jointly(joint, unknowns_of(joint, start), search, {});
            if (!end.holds() || !(end.log_cost_ratio < min)) return;
            min = end.log_cost_ratio;
            best = setting_at(places_.rules(), joint.settings(end.v, from, nullptr), options_.b);
        };
        for (const PointDesign* start : {inside->front(), inside->back()}) consider(start->optimum(), false);
        if (std::ranges::any_of(*inside, &PointDesign::optimum_is_PI))
            for (const PointDesign* start : {inside->front(), inside->back()}) consider(start->optimum(), true);
        if (!best && one_) consider(point_of(*one_), !(one_->Td > 0));
        if (!best) return std::optional<ScheduleRow>();
        return std::optional(ScheduleRow{
            .at = from, .Kp = best->Kp, .Ti = best->Ti, .Td = best->Td, .Tf = best->filter.Tf, .b = options_.b});
    }

    PointDesigns& places_;
    OwnOptima& own_;
    const RangeOptions& options_;
    const std::optional<IdealPid>& one_;
    double low_, high_, hysteresis_, margin_ = kStepsLogMargin;
};

bool suffices(const std::optional<ScheduleDesign>& design) {
    return design && design->holds_limits && design->within_allowance;
}

}  // namespace

Expected<ScheduleDesign> steps_schedule(PointDesigns& places, OwnOptima& own, const RangeOptions& options,
                                        const std::optional<IdealPid>& one) {
    std::optional<ScheduleDesign> best;
    const auto attempt = [&](int rows) -> std::optional<Error> {
        auto design = StepsDesign(places, own, options, one).with(rows);
        if (!design) return design.error();
        const bool better = *design && (!best || suffices(*design) ||
                                        (!suffices(best) && (*design)->worst_relative_IAE < best->worst_relative_IAE));
        if (better) best = **design;
        return std::nullopt;
    };
    if (options.rows) {
        if (auto error = attempt(*options.rows)) return *error;
    } else {
        // Tries the largest number of rows first: if it fails, no smaller number succeeds.
        int enough = kMaxRows, few = 0;
        if (auto error = attempt(enough)) return *error;
        while (suffices(best) && enough - few > 1) {
            const int middle = (enough + few) / 2;
            auto design = StepsDesign(places, own, options, one).with(middle);
            if (!design) return design.error();
            if (suffices(*design)) best = **design;
            (suffices(*design) ? enough : few) = middle;
        }
    }
    if (best) return *best;
    return Error{places.control().stop.stop_requested() ? ErrorKind::cancelled : ErrorKind::no_feasible_controller, "",
                 "No stepwise schedule was found that keeps the limits: in some part of the range no single setting "
                 "keeps them. Allow more rows, or let the settings move linearly between them."};
}

}  // namespace tunewright::range
