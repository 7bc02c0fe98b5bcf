#include <cstdio>
#include <cstdlib>
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

constexpr int kLooks = 48;                // places over the range at which a schedule is verified first
constexpr int kLooksOfPart = 9;           // and between two rows
constexpr int kInsidePart = 3;            // places of a part that a search knows from the beginning
constexpr double kInside = 3e-5;          // of ln of a limit: aimed at, so that places between hold it as well
constexpr double kAllowedExcess = 2e-5;   // of ln of a limit, where it is verified
constexpr double kSmallExcess = 5e-4;     // of it: all limits are tightened by it, rather than a place added
constexpr double kNearLimit = -5e-3;      // of it: tops above it are looked at more closely
constexpr double kNearPrice = 0.01;       // of ln of the price, below what is allowed: the same
constexpr double kPriceRoom = 3e-3;       // of it: kept free for what lies between the search's places
constexpr int kRounds = 8;                // of adding places that exceed
constexpr std::size_t kMostAdded = 6;     // places a round
constexpr double kHopelessLayout = 0.045;  // of the layout's error: fewer rows are not tried
constexpr double kHopelessStep = 0.15;     // of what is left to the price allowed
constexpr int kIterations = 14;

struct Verified {
    double excess = -1, log_price = -1;
    std::vector<double> worst;  ///< places where a limit or the allowance is exceeded most
};

std::vector<double> looked_at(const Places& places, const Schedule& schedule) {
    const double low = places.model().low(), high = places.model().high();
    std::vector<double> at;
    for (int i = 0; i <= kLooks; ++i) at.push_back(low + (high - low) * i / kLooks);
    for (std::size_t k = 1; k < schedule.rows.size(); ++k) {
        const double from = schedule.rows[k - 1].at, width = schedule.rows[k].at - from;
        for (int i = 0; i < kLooksOfPart; ++i) at.push_back(from + width * (i + 0.5) / kLooksOfPart);
    }
    std::sort(at.begin(), at.end());
    return at;
}

/// Looks over the range, ascending, and more of them where they are near a limit or the price allowed.
class Looks {
public:
    Looks(const Places& places, const OwnOptima& own, const Schedule& schedule)
        : places_(places), own_(own), schedule_(schedule) {}

    std::optional<Error> take(double at) {
        const auto look = look_between(places_, own_, in_use(schedule_, at), at, false);
        if (!look) return look.error();
        const auto after = std::ranges::upper_bound(looks_, at, {}, &Look::at);
        looks_.insert(after, *look);
        return std::nullopt;
    }

    /// One more look at the top of the parabola through each local maximum above the threshold and its neighbours.
    std::optional<Error> refine(double Look::*value, double threshold) {
        std::vector<double> wanted;
        for (std::size_t i = 1; i + 1 < looks_.size(); ++i) {
            const Look &a = looks_[i - 1], &b = looks_[i], &c = looks_[i + 1];
            if (!is_top(i, value) || !(b.*value > threshold) || !std::isfinite(a.*value + b.*value + c.*value)) continue;
            const double left = (b.*value - a.*value) / (b.at - a.at), right = (c.*value - b.*value) / (c.at - b.at);
            const double bend = (right - left) / (c.at - a.at);
            if (!(bend < 0)) continue;
            const double top = 0.5 * (a.at + b.at) - 0.5 * left / bend;
            if (top > a.at && top < c.at && top != b.at) wanted.push_back(top);
        }
        for (const double at : wanted)
            if (auto error = take(at)) return error;
        return std::nullopt;
    }

    double largest(double Look::*value) const { return (*std::ranges::max_element(looks_, {}, value)).*value; }

    /// Local maxima above the threshold, the largest first.
    std::vector<double> tops(double Look::*value, double threshold) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < looks_.size(); ++i)
            if (looks_[i].*value > threshold && (is_top(i, value) || !std::isfinite(looks_[i].*value)))
                found.push_back(i);
        std::ranges::stable_sort(found, std::greater{}, [&](std::size_t i) { return looks_[i].*value; });
        found.resize(std::min(found.size(), kMostAdded));
        std::vector<double> at;
        for (const std::size_t i : found) at.push_back(looks_[i].at);
        return at;
    }

private:
    bool is_top(std::size_t i, double Look::*value) const {
        const double here = looks_[i].*value;
        return (i == 0 || looks_[i - 1].*value <= here) && (i + 1 == looks_.size() || looks_[i + 1].*value < here);
    }

    const Places& places_;
    const OwnOptima& own_;
    const Schedule& schedule_;
    std::vector<Look> looks_;
};

Expected<Verified> verify(const Places& places, const OwnOptima& own, const Schedule& schedule, double allowed) {
    Looks looks(places, own, schedule);
    for (const double at : looked_at(places, schedule))
        if (auto error = looks.take(at)) return *error;
    for (int round = 0; round < 2; ++round) {
        if (auto error = looks.refine(&Look::excess, kNearLimit)) return *error;
        if (auto error = looks.refine(&Look::log_price, allowed - kNearPrice)) return *error;
    }
    Verified result{.excess = looks.largest(&Look::excess), .log_price = looks.largest(&Look::log_price), .worst = {}};
    const bool little = result.excess <= kSmallExcess && result.log_price <= allowed;
    if (!little) result.worst = looks.tops(&Look::excess, kAllowedExcess);
    const auto dear = looks.tops(&Look::log_price, allowed);
    result.worst.insert(result.worst.end(), dear.begin(), dear.end());
    return result;
}

class LinearDesign {
public:
    LinearDesign(Places& places, OwnOptima& own, const RangeOptions& options)
        : places_(places), own_(own), options_(options), allowed_(std::log1p(options.allowance)) {}

    /// With so many rows. Empty: the search ended without holding the limits, or above the price wanted.
    Expected<std::optional<ScheduleDesign>> with(int rows, bool least_price) {
        const auto layout = own_.layout(rows, options_.interpolation);
        const Knots knots(places_, options_.interpolation, layout.at);
        JointProblem joint = knots.problem();
        if (auto error = know_parts(layout.at)) return *error;
        JointOptions search;
        search.most_iterations = kIterations;
        search.hopeless = least_price ? 0 : kHopelessStep;
        search.margin = kInside;
        search.enough = least_price ? -1 : allowed_ - kPriceRoom;
        search.stop = places_.control().stop;
        Eigen::VectorXd v = knots.start(own_);
        std::optional<ScheduleDesign> best;
        for (int round = 0; round < kRounds; ++round) {
            const auto known = places_.known();
            joint.places.assign(known.begin(), known.end());
            const auto end = search_jointly(joint, v, search, {});
            v = end.v;
            if (getenv("DBG")) printf("    rows %d round %d places %zu it %d price %.5f excess %.2e\n", rows, round, known.size(), end.iterations, end.log_price, end.excess);
            if (!end.holds() || !std::isfinite(end.log_price)) break;
            if (!least_price && end.log_price > allowed_) break;
            const Schedule schedule = knots.schedule(v, places_.rules(), options_.b);
            const auto verified = verify(places_, own_, schedule, least_price ? end.log_price + kPriceRoom : allowed_);
            if (!verified) return verified.error();
            if (getenv("DBG")) printf("      verified %.5f %.2e added %zu\n", verified->log_price, verified->excess, verified->worst.size());
            keep_better(best, schedule, *verified, end.stopped);
            const bool held = verified->excess <= kAllowedExcess;
            if ((held && verified->worst.empty()) || end.stopped) return best;
            if (!held && verified->worst.empty()) search.margin += 1.2 * verified->excess;
            for (const double at : verified->worst)
                if (const auto place = places_.at(at); !place) return place.error();
            own_.renew(places_);
        }
        return best;
    }

    double allowed() const { return allowed_; }

private:
    /// Some places inside every part, so that no first search is blind there.
    std::optional<Error> know_parts(const std::vector<double>& rows) {
        for (std::size_t k = 1; k < rows.size(); ++k) {
            const double from = rows[k - 1], width = rows[k] - from;
            for (int i = 1; i <= kInsidePart; ++i) {
                const double at = from + width * i / (kInsidePart + 1), near = 0.3 * width / (kInsidePart + 1);
                const bool known = std::ranges::any_of(
                    own_.at(), [&](double other) { return std::abs(other - at) < near; });
                if (known) continue;
                if (const auto place = places_.at(at); !place) return place.error();
            }
        }
        own_.renew(places_);
        return std::nullopt;
    }

    void keep_better(std::optional<ScheduleDesign>& best, const Schedule& schedule, const Verified& verified,
                     bool stopped) const {
        ScheduleDesign design{.schedule = schedule,
                              .holds_limits = verified.excess <= kAllowedExcess,
                              .within_allowance = verified.log_price <= allowed_,
                              .worst_relative_IAE = std::exp(verified.log_price),
                              .partial = stopped,
                              .warnings = {}};
        const bool better = !best || (design.holds_limits && !best->holds_limits) ||
                            (design.holds_limits == best->holds_limits &&
                             design.worst_relative_IAE < best->worst_relative_IAE);
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
    design.warnings.push_back(
        {"schedule-over-allowance",
         "With " + std::to_string(design.schedule.rows.size()) + " rows the schedule costs up to " +
             text(100 * (design.worst_relative_IAE - 1), 3) + " % more IAE than a place's own optimum, and " +
             text(100 * options.allowance, 3) + " % is allowed. Allow more rows, or a larger price."});
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
    const int first = options.rows.value_or(2), last = options.rows.value_or(kMostRows);
    for (int rows = std::max(2, first); rows <= std::max(2, last); ++rows) {
        if (!options.rows && own.layout(rows, options.interpolation).error > kHopelessLayout) continue;
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
    remark(*best, options);
    return *best;
}

}  // namespace

Expected<ScheduleDesign> design_schedule(Places& places, OwnOptima& own, const RangeOptions& options) {
    return linear_schedule(places, own, options);
}

}  // namespace tunewright::range
