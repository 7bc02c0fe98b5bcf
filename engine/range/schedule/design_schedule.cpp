#include "engine/range/schedule/design_schedule.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "engine/number_text.h"
#include "engine/range/schedule/knots.h"
#include "engine/range/schedule/look.h"

namespace tunewright::range {
namespace {

constexpr int kInsidePart = 3;           // places of a part that a search knows from the beginning
constexpr double kInside = 3e-5;         // of ln of a limit: aimed at, so that places between hold it as well
constexpr double kPriceRoom = 1e-3;      // of ln of the price: kept free for what lies between the search's places
constexpr int kRounds = 8;               // of adding places that exceed
constexpr double kHopelessLayout = 0.6;  // of ln of the price allowed, of the layout's error: fewer rows are not tried
constexpr double kHopelessStep = 0.15;   // of what is left to the price allowed
constexpr double kNearby = 0.3;          // of the distance of a search's places inside a part
constexpr int kIterations = 14;

class LinearDesign {
public:
    LinearDesign(Places& places, OwnOptima& own, const RangeOptions& options)
        : places_(places), own_(own), options_(options), allowed_(std::log1p(options.allowance)) {}

    /// With so many rows. Empty: the search ended without holding the limits, or above the price wanted.
    Expected<std::optional<ScheduleDesign>> with(int rows, bool least_price) {
        const auto layout = own_.layout(rows, options_.interpolation);
        const Knots knots(places_, options_.interpolation, layout.at);
        JointProblem joint = knots.problem();
        const auto known = places_of(layout.at);
        if (!known) return known.error();
        joint.places.assign(known->begin(), known->end());
        JointOptions search;
        search.most_iterations = kIterations;
        search.hopeless = least_price ? 0 : kHopelessStep;
        search.margin = kInside;
        search.enough = least_price ? -1 : allowed_ - kPriceRoom;
        search.stop = places_.control().stop;
        Eigen::VectorXd v = knots.start(own_);
        std::optional<ScheduleDesign> best;
        for (int round = 0; round < kRounds; ++round) {
            const auto end = search_jointly(joint, v, search, {});
            v = end.v;
            if (!end.holds() || !std::isfinite(end.log_price)) break;
            if (!least_price && end.log_price > allowed_) break;
            const Schedule schedule = knots.schedule(v, places_.rules(), options_.b);
            const auto verified = verify(places_, own_, schedule, least_price ? end.log_price + kPriceRoom : allowed_);
            if (!verified) return verified.error();
            keep_better(best, schedule, *verified, end.stopped);
            const bool held = verified->excess <= kAllowedLogExcess;
            const bool good = held && verified->worst.empty();
            if (end.stopped || (good && !add_worst_inside(schedule, joint.places))) return best;
            if (good) best.reset();  // plants inside a region have joined, on which it does not hold
            if (!held && verified->worst.empty()) search.margin += 1.2 * verified->excess;
            for (const double at : verified->worst) {
                const auto place = places_.at(at);
                if (!place) return place.error();
                if (std::ranges::find(joint.places, *place) == joint.places.end()) joint.places.push_back(*place);
            }
            own_.renew(places_);
        }
        return best;
    }

private:
    /// The rows' places, where the price is largest, and some inside every part, where the limits are nearest; inside,
    /// what is known nearby serves.
    Expected<std::vector<Place*>> places_of(const std::vector<double>& rows) {
        std::vector<Place*> result;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const auto row = places_.at(rows[k]);
            if (!row) return row.error();
            result.push_back(*row);
            if (k + 1 == rows.size()) break;
            const double width = (rows[k + 1] - rows[k]) / (kInsidePart + 1);
            for (int i = 1; i <= kInsidePart; ++i) {
                const double at = rows[k] + width * i;
                const auto inside = places_.at(near(at, kNearby * width).value_or(at));
                if (!inside) return inside.error();
                result.push_back(*inside);
            }
        }
        own_.renew(places_);
        return result;
    }

    /// At every place with a region of uncertainty: did plants inside it join on which the schedule exceeds a limit?
    /// The place then joins the search.
    bool add_worst_inside(const Schedule& schedule, std::vector<const Place*>& searched) {
        bool added = false;
        for (Place* place : places_.known()) {
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
                              .holds_limits = verified.excess <= kAllowedLogExcess,
                              .within_allowance = verified.log_price <= allowed_,
                              .worst_relative_IAE = std::exp(verified.log_price),
                              .partial = stopped,
                              .warnings = {}};
        const bool better =
            !best || (design.holds_limits && !best->holds_limits) ||
            (design.holds_limits == best->holds_limits && design.worst_relative_IAE < best->worst_relative_IAE);
        if (better) best = design;
    }

    Places& places_;
    OwnOptima& own_;
    const RangeOptions& options_;
    double allowed_;
};

bool satisfies(const std::optional<ScheduleDesign>& design) {
    return design && design->holds_limits && design->within_allowance;
}

/// A warning where the schedule costs more than is allowed.
void remark(ScheduleDesign& design, const RangeOptions& options) {
    if (design.within_allowance) return;
    design.warnings.push_back({"schedule-over-allowance",
                               "With " + std::to_string(design.schedule.rows.size()) +
                                   " rows the schedule costs up to " + text(100 * (design.worst_relative_IAE - 1), 3) +
                                   " % more IAE than a place's own optimum, and " + text(100 * options.allowance, 3) +
                                   " % is allowed. Allow more rows, or a larger price."});
}

void tell(const Places& places, int rows) {
    const RunControl& control = places.control();
    if (!control.progress) return;
    control.progress(Progress{.fraction = std::min(0.9, 0.4 + 0.05 * rows),
                              .stage = "schedule",
                              .message = "schedule with " + std::to_string(rows) + " rows.",
                              .best = {}});
}

Expected<ScheduleDesign> linear_schedule(Places& places, OwnOptima& own, const RangeOptions& options) {
    LinearDesign linear(places, own, options);
    std::optional<ScheduleDesign> best;
    const double hopeless = kHopelessLayout * std::log1p(options.allowance);
    const int first = options.rows.value_or(2), last = options.rows.value_or(kMostRows);
    for (int rows = std::max(2, first); rows <= std::max(2, last); ++rows) {
        if (!options.rows && own.layout(rows, options.interpolation).error > hopeless) continue;
        tell(places, rows);
        auto design = linear.with(rows, options.rows.has_value());
        if (!design) return design.error();
        const bool better = *design && (!best || (*design)->worst_relative_IAE < best->worst_relative_IAE);
        if (better) best = **design;
        if (satisfies(*design) || places.control().stop.stop_requested()) break;
    }
    if (!best)
        return Error{places.control().stop.stop_requested() ? ErrorKind::cancelled : ErrorKind::numerical_failure, "",
                     "No schedule was found whose limits hold between its rows. Narrow the range, or part it where its "
                     "plants change most."};
    return *best;
}

}  // namespace

Expected<ScheduleDesign> design_schedule(Places& places, OwnOptima& own, const RangeOptions& options) {
    const bool one_row = options.rows && *options.rows == 1;
    const bool steps = options.interpolation == Interpolation::steps || one_row;
    auto design = steps ? steps_schedule(places, own, options) : linear_schedule(places, own, options);
    if (design) remark(*design, options);
    return design;
}

}  // namespace tunewright::range
