#include "engine/tuning/robust/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/numerics/extremum.h"
#include "engine/tuning/robust/starts.h"

namespace tunewright::robust {

namespace {

constexpr double kResonant = 0.4;          // damping of a pair below which a plant may have several valleys
constexpr double kSlowZero = 0.3;          // times the reference
constexpr double kShortTd = 0.1;           // times 1/reference: below it the cost hardly depends on ln Td
constexpr double kSameDesign = 0.02;       // of each logarithm
constexpr double kSameValley = 0.1;        // of each logarithm: a rough run that comes so near to an end goes there
constexpr double kHopeless = 0.7;          // of ln of the cost: a start so much dearer than the best is left out
constexpr double kRoughTolerance = 3e-3;   // of ln of the cost: of a run that only shows how deep a valley is
constexpr double kWorthFollowing = 0.02;   // of ln of the cost: so much dearer a valley may still be the deepest
constexpr double kPolishTolerance = 1e-4;  // of ln of the cost
constexpr double kPolishStep = 0.05;       // of a logarithm
constexpr int kMaxPolishing = 50;          // simulations of one simplex
constexpr int kTrial = 8;  // the same of the first one without a set-point step: of 2,800 plants none won 5e-4 later
constexpr int kMaxSimplices = 10;
constexpr double kWorthAnother = 5e-4;  // of ln of the cost: what a simplex won, for the next to begin

// A PI on two slow lags, or on one and an integrator, acts far below the frequency at which a PID would.
constexpr ScanBox kSlowBox = {.Ti_low = 60, .Ti_high = 1000};
// The usual box, looked at more closely.
constexpr ScanBox kCloseBox = {.Ti_points = 27, .Td_points = 21};
// Where the valleys of a resonant plant lie. Beside ordinary designs it may want an integral alone, behind a filter
// that takes the resonance away: short Ti, long Td.
constexpr ScanBox kWideBox = {
    .Ti_points = 9, .Td_points = 8, .Ti_low = 0.01, .Ti_high = 60, .Td_low = 0.02, .Td_high = 60};
// An integral so much alone that Td is but the filter's measure.
constexpr ScanBox kIntegralBox = {
    .Ti_points = 1, .Td_points = 8, .Ti_low = 1e-4, .Ti_high = 1e-4, .Td_low = 1, .Td_high = 250};
// An integral behind a filter that is long beside the reference, as a slow zero may want it.
constexpr ScanBox kFilteredBox = {
    .Ti_points = 4, .Td_points = 4, .Ti_low = 0.05, .Ti_high = 2, .Td_low = 10, .Td_high = 250};
// A loop of so high a gain that a set-point step hardly needs the integral.
constexpr ScanBox kLongTiBox = {
    .Ti_points = 4, .Td_points = 5, .Ti_low = 40, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 2};
constexpr double kBeyondLag = 2;  // times it

bool has_setpoint(const DesignProblem& problem) {
    return problem.objective == Objective::setpoint_iae || problem.objective == Objective::weighted;
}

bool any_plant(const DesignProblem& problem, bool (*is)(const LinearPlant&)) {
    if (problem.measured) return false;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (is(problem.plant_at(i))) return true;
    return false;
}

bool has_resonant_plant(const DesignProblem& problem) { return any_plant(problem, is_resonant); }

/// The designs of a stable plant without zeros hang together over those of low gain, which are within every limit: of
/// some 6000 random ones none had an island.
bool may_have_islands(const LinearPlant& plant) {
    return plant.integrators() != 0 || !plant.zeros().empty() ||
           std::ranges::any_of(plant.poles(), [](std::complex<double> pole) { return pole.real() >= 0; });
}

/// Above a slow zero, on either side, the loop may want a filter that keeps it below.
bool has_slow_zero(const DesignProblem& problem, double reference) {
    return problem.plant != nullptr && std::ranges::any_of(problem.plant->zeros(), [&](std::complex<double> zero) {
               return std::abs(zero) < kSlowZero * reference;
           });
}

bool has_kinks(const DesignProblem& problem) {
    return has_setpoint(problem) || (problem.objective == Objective::load_iae && has_resonant_plant(problem));
}

double short_Td(const Sweep& sweep) { return std::log(kShortTd / sweep.reference()); }

/// Runs of the quadratic programming from one start after the other; the cheapest design counts.
class Runs {
public:
    Runs(const Sweep& sweep, const DesignProblem& problem, const Report& report)
        : sweep_(sweep), problem_(problem), report_(report) {}

    /// A start without a settled response may be given: nothing then comes of it.
    void from(const std::optional<Candidate>& start) {
        if (start && !stopped()) run(*start, {.stable_start = start->stable}, &Runs::at_known_end);
    }

    /// The same of a valley that is likely not the deepest: it is followed to its end only where it may be.
    void explore(const std::optional<Candidate>& start) {
        if (!start || stopped() || in_known_valley(start->x)) return;
        const double before = best_ ? best_->log_cost : kNoDesign;
        const SqpResult rough =
            run(*start,
                {.cost_tolerance = kRoughTolerance, .stable_start = start->stable, .wanted = before + kWorthFollowing},
                &Runs::in_known_valley);
        if (stopped() || !rough.converged || rough.log_cost > before + kWorthFollowing) return;
        ends_.pop_back();
        run({rough.x, rough.log_cost, rough.stable}, {.stable_start = rough.stable, .curvature = rough.curvature},
            &Runs::at_known_end);
    }

    /// By simplices, from the best so far: the integral of |e| has kinks where a slow tail after a set-point step, or a
    /// wave of a resonance, comes to change its sign, and a descent along smooth models stalls on them.
    void polish() {
        for (int round = 0; round < kMaxSimplices && best_ && !stopped(); ++round) {
            const double before = best_->log_cost;
            simplex(round > 0 || has_setpoint(problem_) ? kMaxPolishing : kTrial);
            if (before - best_->log_cost < kWorthAnother) break;
        }
    }

    bool stopped() const { return best_ && best_->stopped; }
    const std::optional<Found>& best() const { return best_; }

private:
    /// `arrived`: nothing more is to be learnt from here on.
    SqpResult run(const Candidate& start, const SqpOptions& options, bool (Runs::*arrived)(const DesignPoint&) const) {
        bool stop = false;
        const Report watch = [&](const DesignPoint& x, double cost) {
            stop =
                report_ && !(best_ && best_->log_cost < cost ? report_(best_->x, best_->log_cost) : report_(x, cost));
            return !stop && !(this->*arrived)(x);
        };
        const SqpResult result = minimise(sweep_, problem_, start.x, options, watch);
        const double cost = std::isfinite(result.log_cost) ? result.log_cost : start.log_cost;
        ends_.push_back(result.x);
        take({result.x, cost, stop, result.curvature});
        return result;
    }

    void simplex(int most_evaluations) {
        const DesignPoint start = best_->x;
        // The unknowns are steps from the start: a logarithm's own size depends on the unit of time.
        const auto cost = [&](const std::vector<double>& step, bool& stop) {
            DesignPoint x = start;
            for (std::size_t i = 0; i < step.size(); ++i) x[i] += step[i];
            const auto feasible = feasible_near(sweep_, x);
            if (!feasible) return kNoDesign;
            const double value = std::min(kNoDesign, log_cost(problem_, *feasible, SqpOptions{}.simulation_tolerance));
            if (value < best_->log_cost)
                take({*feasible, value, report_ && !report_(*feasible, value), best_->curvature});
            stop = stopped();
            return value;
        };
        const auto n = static_cast<std::size_t>(problem_.dimension());
        find_local_minimum(LocalSearch::nelder_mead, cost, std::vector<double>(n, 0.0),
                           {.step = std::vector<double>(n, kPolishStep),
                            .tolerance = kPolishTolerance,
                            .most_evaluations = most_evaluations});
    }

    void take(const Found& found) {
        const bool stop = found.stopped || stopped();
        if (!best_ || found.log_cost < best_->log_cost) best_ = found;
        best_->stopped = stop;
    }

    bool at_known_end(const DesignPoint& x) const { return known(x, kSameDesign); }
    bool in_known_valley(const DesignPoint& x) const { return known(x, kSameValley); }

    /// Near an end in all logarithms; all short Td are one.
    bool known(const DesignPoint& x, double same) const {
        const double least_Td = short_Td(sweep_);
        return std::ranges::any_of(ends_, [&](const DesignPoint& end) {
            return std::abs(x[0] - end[0]) <= same && std::abs(x[1] - end[1]) <= same &&
                   std::abs(std::max(x[2], least_Td) - std::max(end[2], least_Td)) <= same;
        });
    }

    const Sweep& sweep_;
    const DesignProblem& problem_;
    const Report& report_;
    std::vector<DesignPoint> ends_;
    std::optional<Found> best_;
};

/// A run that ends at a short Td may have been led there by the flatness of the cost alone: Td has to prove itself
/// against the least one and against a long one.
void look_beyond_short_Td(Runs& runs, const Sweep& sweep, const DesignProblem& problem, std::vector<ScanPoint> points) {
    const double shortest = std::log(kMinTd / sweep.reference()), ordinary = short_Td(sweep);
    const DesignPoint end = runs.best()->x;
    if (end[2] > ordinary) return;
    const DesignPoint nearly_PI = {end[0], end[1], shortest};
    runs.from(Candidate{.x = nearly_PI, .stable = sweep.stays_stable(end, nearly_PI)});
    std::erase_if(points, [&](const ScanPoint& point) { return point.x[2] <= ordinary; });
    runs.from(cheapest(problem, points));
}

/// A Ti that cancels the slowest lag lies inside.
ScanBox long_Ti_box(const DesignProblem& problem, double reference) {
    ScanBox box = kLongTiBox;
    const double spacing = std::pow(box.Ti_high / box.Ti_low, 1.0 / (box.Ti_points - 1));
    if (problem.plant != nullptr)
        for (const auto pole : problem.plant->poles())
            if (pole != 0.0) box.Ti_high = std::max(box.Ti_high, kBeyondLag * reference / std::abs(pole));
    box.Ti_points = 1 + static_cast<int>(std::ceil(std::log(box.Ti_high / box.Ti_low) / std::log(spacing)));
    return box;
}

/// Where a long Ti wins from the start, kinks lie so close that one run rarely ends beside the lowest.
void look_at_long_Ti(Runs& runs, const Sweep& sweep, const DesignProblem& problem) {
    const auto points = scan(sweep, long_Ti_box(problem, sweep.reference()));
    const double before = runs.best()->log_cost;
    const auto best = cheapest(problem, points, before + kHopeless);
    runs.from(best);
    if (!best || best->log_cost >= before) return;
    for (const auto& start : valley_starts(problem, points))
        if (start.log_cost < before + kHopeless) runs.from(start);
}

void look_for_valleys(Runs& runs, const Sweep& sweep, const DesignProblem& problem,
                      const std::vector<ScanPoint>& points) {
    // Under a limit on |C S| gain is traded against filtering, with several valleys along Td.
    if (problem.limits.Mks)
        for (const auto& valley : valley_starts(problem, points)) runs.from(valley);
    if (has_setpoint(problem)) look_at_long_Ti(runs, sweep, problem);
    const auto look_in = [&](const ScanBox& box) {
        runs.explore(cheapest(problem, scan(sweep, box), runs.best()->log_cost + kHopeless));
    };
    if (!has_resonant_plant(problem)) {
        if (has_slow_zero(problem, sweep.reference())) look_in(kFilteredBox);
        return;
    }
    const double hopeless = runs.best()->log_cost + kHopeless;
    for (const auto& valley : valley_starts(problem, scan(sweep, kWideBox, Stability::told, hopeless), short_Td(sweep)))
        runs.explore(valley);
    look_in(kIntegralBox);
    if (any_plant(problem, may_have_islands)) runs.explore(cheapest_island(sweep, problem, runs.best()->log_cost));
}

}  // namespace

bool is_resonant(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return pole.imag() > 0 && std::abs(pole.real()) < kResonant * std::abs(pole);
    });
}

std::optional<Found> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report) {
    std::vector<ScanPoint> points;
    for (const ScanBox& box : {ScanBox{}, kSlowBox, kCloseBox})
        if (points.empty()) points = scan(sweep, box);
    if (points.empty()) return std::nullopt;
    const auto start = best_start(sweep, problem, points);
    if (!start) return std::nullopt;
    Runs runs(sweep, problem, report);
    runs.from(*start);
    if (problem.pid) {
        look_beyond_short_Td(runs, sweep, problem, points);
        look_for_valleys(runs, sweep, problem, points);
    } else if (has_setpoint(problem)) {
        look_at_long_Ti(runs, sweep, problem);
    }
    for (const auto& x : problem.optimal_for_part) runs.explore(Candidate{.x = x, .stable = true});
    if (has_kinks(problem)) runs.polish();
    return runs.best();
}

namespace {

constexpr double kPlaneTolerance = 1e-4;  // of the simulations
constexpr double kCorner = 0.4;           // of the simplex, to the first (the paper's section 4.2)
constexpr int kGridPoints = 25;
constexpr double kGridReach = 3.0;  // ln: a factor of 20 to either side
constexpr int kGridRounds = 4;
constexpr double kGridFiner = 6;      // of a round's reach, over the next one's
constexpr int kMaxTightening = 4;     // Newton steps in ln Kp
constexpr double kNearLimit = -0.05;  // peaks below it do not end a gap
constexpr double kLeastSlope = 1e-3;  // of a peak over ln Kp: a flatter one is not moved by the gain
constexpr double kAimBelow = 1e-8;    // of a peak's logarithm: inside the limit
constexpr double kTight = 1e-10;      // of ln Kp: the step that changes nothing any more
constexpr double kFarStep = 0.1;      // of ln Kp: a step that leaves the gap's end
constexpr double kClosed = 1e-5;      // of a peak's logarithm: between grid points the gap is closed after all
constexpr double kNoTd = 1e-300;      // in place of Td = 0, whose logarithm is not used

/// Newton in ln(Kp) alone, from the grid's tangency to the refined peak's.
void tighten(const Sweep& sweep, DesignPoint& x, bool upper_end) {
    for (int k = 0; k < kMaxTightening; ++k) {
        const auto peaks = sweep.peaks(x, kNearLimit);
        if (peaks.empty()) return;
        const ActivePeak* limit = nullptr;
        for (const auto& peak : peaks)
            if ((peak.gradient[0] > 0) == upper_end) {
                limit = &peak;
                break;
            }
        if (limit == nullptr || std::abs(limit->gradient[0]) < kLeastSlope) return;
        const double step = -(limit->value + kAimBelow) / limit->gradient[0];
        if (std::abs(step) < kTight || std::abs(step) > kFarStep) return;
        x[0] += step;
    }
}

struct PlaneSearch {
    const Sweep* sweep;
    const DesignProblem* problem;
    const Report* report;
    std::optional<Found> best;

    double cost(double log_Ti, double log_Td) {
        const auto found = best_gain(*sweep, *problem, std::exp(log_Ti), std::exp(log_Td), kPlaneTolerance);
        if (!found) return kNoDesign;
        if (!best || found->log_cost < best->log_cost) {
            best = found;
            best->stopped = *report && !(*report)(found->x, found->log_cost);
        }
        return found->log_cost;
    }
    bool stopped() const { return best && best->stopped; }
};

}  // namespace

std::optional<Found> best_gain(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                               double tolerance) {
    std::optional<Found> best;
    const auto gains = feasible_gains(sweep, Ti, Td);
    for (std::size_t i = 0; i < gains.size(); ++i) {
        DesignPoint x = {std::log(gains[i].Kp), std::log(Ti), problem.pid ? std::log(Td) : 0};
        tighten(sweep, x, i % 2 == 0);  // the ends of a gap follow each other, the upper one first
        if (best && log_cost_bound(problem, x) >= best->log_cost) continue;
        const auto peaks = sweep.peaks(x, kNearLimit);
        if (!peaks.empty() && peaks[0].value > kClosed) continue;
        const double cost = log_cost(problem, x, tolerance);
        if (std::isfinite(cost) && (!best || cost < best->log_cost)) best = Found{x, cost, false};
    }
    return best;
}

std::optional<Found> nelder_mead_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                        const Report& report) {
    PlaneSearch search{&sweep, &problem, &report, std::nullopt};
    // The unknowns are steps from the first corner: a logarithm's own size depends on the unit of time.
    const auto cost = [&](const std::vector<double>& step, bool& stop) {
        const double value = search.cost(std::log(Ti) + step[0], problem.pid ? std::log(Td) + step[1] : 0);
        stop = search.stopped();
        return value;
    };
    const std::size_t n = problem.pid ? 2 : 1;
    find_local_minimum(LocalSearch::nelder_mead, cost, std::vector<double>(n, 0.0),
                       {.step = std::vector<double>(n, std::log(kCorner))});
    return search.best;
}

std::optional<Found> grid_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                 CostSurface* surface, const Report& report) {
    PlaneSearch search{&sweep, &problem, &report, std::nullopt};
    double centre_Ti = std::log(Ti), centre_Td = std::log(std::max(Td, kNoTd)), reach = kGridReach;
    const int Td_points = problem.pid ? kGridPoints : 1;
    for (int round = 0; round < kGridRounds; ++round, reach /= kGridFiner) {
        const auto at = [&](double centre, int i, int n) {
            return n == 1 ? centre : centre + reach * (2.0 * i / (n - 1) - 1);
        };
        for (int i = 0; i < kGridPoints; ++i) {
            if (surface != nullptr && round == 0) {
                surface->Ti.push_back(std::exp(at(centre_Ti, i, kGridPoints)));
                surface->cost.emplace_back();
            }
            for (int j = 0; j < Td_points; ++j) {
                const double log_cost = search.cost(at(centre_Ti, i, kGridPoints), at(centre_Td, j, Td_points));
                if (search.stopped()) return search.best;
                if (surface == nullptr || round != 0) continue;
                if (i == 0) surface->Td.push_back(problem.pid ? std::exp(at(centre_Td, j, Td_points)) : 0);
                surface->cost.back().push_back(log_cost < kNoDesign ? std::optional<double>(std::exp(log_cost))
                                                                    : std::nullopt);
            }
        }
        if (!search.best) return std::nullopt;
        centre_Ti = search.best->x[1];
        if (problem.pid) centre_Td = search.best->x[2];
    }
    return search.best;
}

}  // namespace tunewright::robust
