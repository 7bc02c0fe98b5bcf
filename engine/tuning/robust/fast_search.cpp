#include "engine/tuning/robust/fast_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/identification/local_minimum.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kScanTolerance = 1e-3;  // of the simulations that only compare starting points
constexpr int kMostCompared = 12;
constexpr std::size_t kMostValleys = 4;
constexpr double kResonant = 0.4;          // damping of a pair below which a plant may have several valleys
constexpr double kShortTd = 0.1;           // times 1/reference: below it the cost hardly depends on ln Td
constexpr double kSameDesign = 0.02;       // of each logarithm
constexpr double kPolishTolerance = 1e-5;  // of ln of the cost
constexpr double kPolishStep = 0.1;        // of a logarithm
constexpr int kMostPolishing = 100;        // simulations of one simplex
constexpr int kMostSimplices = 3;
constexpr double kWorthAnother = 1e-4;  // of ln of the cost: what a simplex won, for the next to begin

// Where the valleys of a resonant plant lie. Beside ordinary designs it may want an integral alone, behind a filter
// that takes the resonance away: short Ti, long Td.
constexpr ScanBox kWideBox = {
    .Ti_points = 9, .Td_points = 8, .Ti_low = 0.01, .Ti_high = 60, .Td_low = 0.02, .Td_high = 60};
// A loop of so high a gain that a set-point step hardly needs the integral.
constexpr ScanBox kLongTiBox = {
    .Ti_points = 2, .Td_points = 5, .Ti_low = 300, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 2};

// Islands of high gain, which may be narrower than any scan's spacing, are wider under wider limits.
constexpr double kWiderLimits = 1.4;  // times M - 1
constexpr ScanBox kIslandBox = {
    .Ti_points = 12, .Td_points = 12, .Ti_low = 0.01, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 60};

struct Candidate {
    Point x{};
    double log_cost = std::numeric_limits<double>::infinity();
};

void consider(Candidate& best, const Problem& problem, const Point& x) {
    if (log_cost_bound(problem, x) >= best.log_cost) return;
    const double cost = log_cost(problem, x, kScanTolerance);
    if (cost < best.log_cost) best = {x, cost};
}

/// The least integrated error Ti/Kp costs sweeps only, and often is next to the optimum (Garpinger and Hagglund 2008;
/// Hast et al. 2013).
Point least_integrated_error(const Sweep& sweep, Problem problem, const Point& start) {
    problem.objective = Objective::load_ie;
    SqpOptions options;
    options.cost_tolerance = 1e-4;
    return minimise(sweep, problem, start, options, {}).x;
}

/// The cheapest point of each Td, cheapest first.
std::vector<Candidate> valley_starts(const Problem& problem, const std::vector<ScanPoint>& points) {
    std::vector<Candidate> starts;
    for (const auto& point : points) {
        const auto same_Td = [&](const Candidate& c) { return std::abs(c.x[2] - point.x[2]) < 1e-9; };
        auto at = std::find_if(starts.begin(), starts.end(), same_Td);
        if (at == starts.end()) at = starts.insert(starts.end(), Candidate{.x = point.x});
        consider(*at, problem, point.x);
    }
    std::erase_if(starts, [](const Candidate& c) { return !std::isfinite(c.log_cost); });
    std::sort(starts.begin(), starts.end(),
              [](const Candidate& a, const Candidate& b) { return a.log_cost < b.log_cost; });
    // Runs on the integrated error need no simulation.
    if (starts.size() > kMostValleys && problem.objective != Objective::load_ie) starts.resize(kMostValleys);
    return starts;
}

/// The cheapest of the least integrated error and the scan's points; empty if no response settles.
std::optional<Candidate> best_start(const Sweep& sweep, const Problem& problem, const std::vector<ScanPoint>& points) {
    const Point integrated = least_integrated_error(sweep, problem, points.front().x);
    Candidate best;
    if (is_stable(problem, integrated)) consider(best, problem, integrated);
    int compared = 0;
    for (const auto& point : points) {
        if (log_cost_bound(problem, point.x) >= best.log_cost) break;  // the points ascend in it
        if (++compared > kMostCompared && std::isfinite(best.log_cost)) break;
        consider(best, problem, point.x);
    }
    if (std::isfinite(best.log_cost)) return best;
    // No response settles within the steps allowed (time scales too far apart): the least integrated error still is a
    // design.
    if (feasible_near(sweep, integrated)) return Candidate{integrated, integrated[1] - integrated[0]};
    return std::nullopt;
}

bool has_setpoint(const Problem& problem) {
    return problem.objective == Objective::setpoint_iae || problem.objective == Objective::weighted;
}

bool is_resonant(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return pole.imag() > 0 && std::abs(pole.real()) < kResonant * std::abs(pole);
    });
}

bool has_resonant_plant(const Problem& problem) {
    if (problem.measured) return false;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (is_resonant(problem.plant_at(i))) return true;
    return false;
}

/// Runs of the quadratic programming from one start after the other; the cheapest design counts.
class Runs {
public:
    Runs(const Sweep& sweep, const Problem& problem, const Report& report)
        : sweep_(sweep), problem_(problem), report_(report) {}

    /// A start without a settled response may be given: nothing then comes of it.
    void from(const Candidate& start) {
        if (stopped()) return;
        bool stop = false;
        const Report watch = [&](const Point& x, double cost) {
            stop =
                report_ && !(best_ && best_->log_cost < cost ? report_(best_->x, best_->log_cost) : report_(x, cost));
            return !stop && !known(x);
        };
        const SqpResult result = minimise(sweep_, problem_, start.x, {}, watch);
        const double cost = std::isfinite(result.log_cost) ? result.log_cost : start.log_cost;
        ends_.push_back(result.x);
        take({result.x, cost, stop});
    }

    /// By simplices, from the best so far: the integral of |e| after a set-point step has kinks where a slow tail
    /// changes its sign, and a descent along smooth models stalls on them.
    void polish() {
        for (int round = 0; round < kMostSimplices && best_ && !stopped(); ++round) {
            const double before = best_->log_cost;
            simplex();
            if (before - best_->log_cost < kWorthAnother) break;
        }
    }

    bool stopped() const { return best_ && best_->stopped; }
    const std::optional<Found>& best() const { return best_; }

private:
    void simplex() {
        const Point start = best_->x;
        // The unknowns are steps from the start: a logarithm's own size depends on the unit of time.
        const auto cost = [&](const std::vector<double>& step, bool& stop) {
            Point x = start;
            for (std::size_t i = 0; i < step.size(); ++i) x[i] += step[i];
            const auto feasible = feasible_near(sweep_, x);
            if (!feasible) return kNoDesign;
            const double value = std::min(kNoDesign, log_cost(problem_, *feasible, SqpOptions{}.simulation_tolerance));
            if (value < best_->log_cost) take({*feasible, value, report_ && !report_(*feasible, value)});
            stop = stopped();
            return value;
        };
        const auto n = static_cast<std::size_t>(problem_.dimension());
        find_local_minimum(LocalSearch::nelder_mead, cost, std::vector<double>(n, 0.0),
                           {.step = std::vector<double>(n, kPolishStep),
                            .tolerance = kPolishTolerance,
                            .most_evaluations = kMostPolishing});
    }

    void take(const Found& found) {
        const bool stop = found.stopped || stopped();
        if (!best_ || found.log_cost < best_->log_cost) best_ = found;
        best_->stopped = stop;
    }

    bool known(const Point& x) const {
        return std::ranges::any_of(ends_, [&](const Point& end) {
            for (std::size_t i = 0; i < 3; ++i)
                if (std::abs(x[i] - end[i]) > kSameDesign) return false;
            return true;
        });
    }

    const Sweep& sweep_;
    const Problem& problem_;
    const Report& report_;
    std::vector<Point> ends_;
    std::optional<Found> best_;
};

/// The cheapest of some points.
Candidate cheapest(const Problem& problem, const std::vector<ScanPoint>& points) {
    Candidate best;
    for (const auto& point : points) consider(best, problem, point.x);
    return best;
}

/// The cheapest of the points that wider limits admit, moved inside the true ones; none that costs `below` or more.
Candidate cheapest_island(const Sweep& sweep, const Problem& problem, double below) {
    Problem wider = problem;
    for (double* limit : {&wider.limits.Ms, &wider.limits.Mt}) *limit = 1 + (*limit - 1) * kWiderLimits;
    Candidate best;
    best.log_cost = below;
    for (const auto& point : scan(Sweep(wider, sweep.reference()), kIslandBox)) {
        if (log_cost_bound(problem, point.x) >= best.log_cost) continue;
        if (const auto inside = feasible_near(sweep, point.x)) consider(best, problem, *inside);
    }
    return best;
}

/// A run that ends at a short Td may have been led there by the flatness of the cost alone: Td has to prove itself
/// against the least one and against a long one.
void look_beyond_short_Td(Runs& runs, const Sweep& sweep, const Problem& problem, std::vector<ScanPoint> points) {
    const double shortest = std::log(kLeastTd / sweep.reference()), ordinary = std::log(kShortTd / sweep.reference());
    const Point end = runs.best()->x;
    if (end[2] > ordinary) return;
    runs.from({.x = {end[0], end[1], shortest}});
    std::erase_if(points, [&](const ScanPoint& point) { return point.x[2] <= ordinary; });
    runs.from(cheapest(problem, points));
}

void look_for_valleys(Runs& runs, const Sweep& sweep, const Problem& problem, const std::vector<ScanPoint>& points) {
    // Under a limit on |C S| gain is traded against filtering, with several valleys along Td.
    if (problem.limits.Mks)
        for (const auto& valley : valley_starts(problem, points)) runs.from(valley);
    if (!has_resonant_plant(problem)) return;
    for (const auto& valley : valley_starts(problem, scan(sweep, kWideBox))) runs.from(valley);
    if (has_setpoint(problem)) runs.from(cheapest(problem, scan(sweep, kLongTiBox)));
    const double before = runs.best()->log_cost;
    const Candidate island = cheapest_island(sweep, problem, before);
    if (island.log_cost < before) runs.from(island);
}

}  // namespace

std::optional<Found> fast_search(const Sweep& sweep, const Problem& problem, const Report& report) {
    std::vector<ScanPoint> points = scan(sweep);
    if (points.empty()) points = scan(sweep, {.Ti_points = 27, .Td_points = 21});
    if (points.empty()) return std::nullopt;
    const auto start = best_start(sweep, problem, points);
    if (!start) return std::nullopt;
    Runs runs(sweep, problem, report);
    runs.from(*start);
    if (problem.pid) {
        look_beyond_short_Td(runs, sweep, problem, points);
        look_for_valleys(runs, sweep, problem, points);
    }
    if (has_setpoint(problem)) runs.polish();
    return runs.best();
}

}  // namespace tunewright::robust
