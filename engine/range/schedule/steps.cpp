#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/range/schedule/design_schedule.h"
#include "engine/range/schedule/look.h"

namespace tunewright::range {
namespace {

constexpr double kStepsInside = 3e-5;  // of ln of a limit: aimed at, so that places between hold it as well
constexpr int kStepsRounds = 4;        // of tightening
constexpr int kPlacesOfPart = 3;       // that each part's search knows at least, ends included

class StepsDesign {
public:
    StepsDesign(Places& places, OwnOptima& own, const RangeOptions& options)
        : places_(places),
          own_(own),
          options_(options),
          low_(places.model().low()),
          high_(places.model().high()),
          hysteresis_(options.hysteresis * (high_ - low_)) {}

    Expected<std::optional<ScheduleDesign>> with(int rows) {
        auto layout = own_.layout(rows, Interpolation::steps).at;
        std::optional<ScheduleDesign> best;
        for (int round = 0; round < kStepsRounds; ++round) {
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
            design.holds_limits = verified->excess <= kAllowedLogExcess;
            design.worst_relative_IAE = std::exp(verified->log_price);
            design.within_allowance = design.worst_relative_IAE <= 1 + options_.allowance;
            design.partial = places_.control().stop.stop_requested();
            if (!best || design.holds_limits || !best->holds_limits) best = design;
            if (design.holds_limits || !std::isfinite(verified->excess) || design.partial) break;
            margin_ += 1.2 * verified->excess;
        }
        return best;
    }

private:
    /// The places of a part with the hysteresis beyond its ends.
    Expected<std::vector<Place*>> places_of(double from, double to) {
        const double begin = std::max(low_, from - 0.5 * hysteresis_), end = std::min(high_, to + 0.5 * hysteresis_);
        for (int i = 0; i < kPlacesOfPart; ++i) {
            const double at = i + 1 == kPlacesOfPart ? end : begin + (end - begin) * i / (kPlacesOfPart - 1);
            if (const auto place = places_.at(at); !place) return place.error();
        }
        std::vector<Place*> inside;
        for (Place* place : places_.known())
            if (place->at() >= begin && place->at() <= end) inside.push_back(place);
        return inside;
    }

    /// Empty: no setting that holds the limits was found.
    Expected<std::optional<ScheduleRow>> serve(double from, double to) {
        const auto inside = places_of(from, to);
        if (!inside) return inside.error();
        const JointProblem joint = one_setting_problem(*inside, options_);
        JointOptions search;
        search.margin = margin_;
        search.stop = places_.control().stop;
        std::optional<JointResult> best;
        for (const Place* start : {inside->front(), inside->back()}) {
            Eigen::VectorXd v(joint.low.size());
            for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = start->optimum()[std::size_t(i)];
            auto end = search_jointly(joint, v, search, {});
            if (end.holds() && std::isfinite(end.log_price) && (!best || end.log_price < best->log_price))
                best = std::move(end);
        }
        if (!best) return std::optional<ScheduleRow>();
        const IdealPid pid =
            setting_at(places_.rules(), {best->v[0], best->v[1], best->v.size() > 2 ? best->v[2] : 0}, options_.b);
        return std::optional(
            ScheduleRow{.at = from, .Kp = pid.Kp, .Ti = pid.Ti, .Td = pid.Td, .Tf = pid.filter.Tf, .b = options_.b});
    }

    Places& places_;
    OwnOptima& own_;
    const RangeOptions& options_;
    double low_, high_, hysteresis_, margin_ = kStepsInside;
};

bool suffices(const std::optional<ScheduleDesign>& design) {
    return design && design->holds_limits && design->within_allowance;
}

}  // namespace

Expected<ScheduleDesign> steps_schedule(Places& places, OwnOptima& own, const RangeOptions& options) {
    std::optional<ScheduleDesign> best;
    const auto attempt = [&](int rows) -> std::optional<Error> {
        auto design = StepsDesign(places, own, options).with(rows);
        if (!design) return design.error();
        const bool better = *design && (!best || suffices(*design) ||
                                        (!suffices(best) && (*design)->worst_relative_IAE < best->worst_relative_IAE));
        if (better) best = **design;
        return std::nullopt;
    };
    if (options.rows) {
        if (auto error = attempt(*options.rows)) return *error;
    } else {
        // The most rows first: where even they do not do, none fewer will.
        int enough = kMostRows, few = 0;
        if (auto error = attempt(enough)) return *error;
        while (suffices(best) && enough - few > 1) {
            const int middle = (enough + few) / 2;
            auto design = StepsDesign(places, own, options).with(middle);
            if (!design) return design.error();
            if (suffices(*design)) best = **design;
            (suffices(*design) ? enough : few) = middle;
        }
    }
    if (best) return *best;
    return Error{places.control().stop.stop_requested() ? ErrorKind::cancelled : ErrorKind::no_feasible_controller, "",
                 "No steps of settings were found that keep the limits: over some part of the range no one setting "
                 "does. Allow more rows, or let the settings move linearly between them."};
}

}  // namespace tunewright::range
