#include "engine/tuning/robust/fast_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/numerics/extremum.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/starts.h"

namespace tunewright::robust {
namespace {

constexpr double kResonant = 0.4;          // damping of a pair below which a plant may have several valleys
constexpr double kShortTd = 0.1;           // times 1/reference: below it the cost hardly depends on ln Td
constexpr double kSameDesign = 0.02;       // of each logarithm
constexpr double kHopeless = 0.7;          // of ln of the cost: a start so much dearer than the best is left out
constexpr double kPolishTolerance = 1e-5;  // of ln of the cost
constexpr double kPolishStep = 0.1;        // of a logarithm
constexpr int kMaxPolishing = 100;         // simulations of one simplex
constexpr int kMaxSimplices = 10;
constexpr double kWorthAnother = 1e-4;  // of ln of the cost: what a simplex won, for the next to begin

// Where the valleys of a resonant plant lie. Beside ordinary designs it may want an integral alone, behind a filter
// that takes the resonance away: short Ti, long Td.
constexpr ScanBox kWideBox = {
    .Ti_points = 9, .Td_points = 8, .Ti_low = 0.01, .Ti_high = 60, .Td_low = 0.02, .Td_high = 60};
// An integral so much alone that Td is but the filter's measure.
constexpr ScanBox kIntegralBox = {
    .Ti_points = 1, .Td_points = 8, .Ti_low = 1e-4, .Ti_high = 1e-4, .Td_low = 1, .Td_high = 250};
// A loop of so high a gain that a set-point step hardly needs the integral.
constexpr ScanBox kLongTiBox = {
    .Ti_points = 4, .Td_points = 5, .Ti_low = 40, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 2};

bool has_setpoint(const DesignProblem& problem) {
    return problem.objective == Objective::setpoint_iae || problem.objective == Objective::weighted;
}

bool is_resonant(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return pole.imag() > 0 && std::abs(pole.real()) < kResonant * std::abs(pole);
    });
}

bool has_resonant_plant(const DesignProblem& problem) {
    if (problem.measured) return false;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (is_resonant(problem.plant_at(i))) return true;
    return false;
}

bool has_kinks(const DesignProblem& problem) {
    return has_setpoint(problem) || (problem.objective == Objective::load_iae && has_resonant_plant(problem));
}

/// Runs of the quadratic programming from one start after the other; the cheapest design counts.
class Runs {
public:
    Runs(const Sweep& sweep, const DesignProblem& problem, const Report& report)
        : sweep_(sweep), problem_(problem), report_(report) {}

    /// A start without a settled response may be given: nothing then comes of it.
    void from(const std::optional<Candidate>& start) {
        if (!start || stopped()) return;
        bool stop = false;
        const Report watch = [&](const DesignPoint& x, double cost) {
            stop =
                report_ && !(best_ && best_->log_cost < cost ? report_(best_->x, best_->log_cost) : report_(x, cost));
            return !stop && !known(x);
        };
        const SqpResult result = minimise(sweep_, problem_, start->x, {}, watch);
        const double cost = std::isfinite(result.log_cost) ? result.log_cost : start->log_cost;
        ends_.push_back(result.x);
        take({result.x, cost, stop});
    }

    /// By simplices, from the best so far: the integral of |e| has kinks where a slow tail after a set-point step, or a
    /// wave of a resonance, comes to change its sign, and a descent along smooth models stalls on them.
    void polish() {
        for (int round = 0; round < kMaxSimplices && best_ && !stopped(); ++round) {
            const double before = best_->log_cost;
            simplex();
            if (before - best_->log_cost < kWorthAnother) break;
        }
    }

    bool stopped() const { return best_ && best_->stopped; }
    const std::optional<Found>& best() const { return best_; }

private:
    void simplex() {
        const DesignPoint start = best_->x;
        // The unknowns are steps from the start: a logarithm's own size depends on the unit of time.
        const auto cost = [&](const std::vector<double>& step, bool& stop) {
            DesignPoint x = start;
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
                            .most_evaluations = kMaxPolishing});
    }

    void take(const Found& found) {
        const bool stop = found.stopped || stopped();
        if (!best_ || found.log_cost < best_->log_cost) best_ = found;
        best_->stopped = stop;
    }

    bool known(const DesignPoint& x) const {
        return std::ranges::any_of(ends_, [&](const DesignPoint& end) {
            for (std::size_t i = 0; i < 3; ++i)
                if (std::abs(x[i] - end[i]) > kSameDesign) return false;
            return true;
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
    const double shortest = std::log(kMinTd / sweep.reference()), ordinary = std::log(kShortTd / sweep.reference());
    const DesignPoint end = runs.best()->x;
    if (end[2] > ordinary) return;
    runs.from(Candidate{.x = {end[0], end[1], shortest}});
    std::erase_if(points, [&](const ScanPoint& point) { return point.x[2] <= ordinary; });
    runs.from(cheapest(problem, points));
}

/// Where a long Ti wins from the start, kinks lie so close that one run rarely ends beside the lowest.
void look_at_long_Ti(Runs& runs, const Sweep& sweep, const DesignProblem& problem) {
    const auto points = scan(sweep, kLongTiBox);
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
    if (!has_resonant_plant(problem)) return;
    for (const auto& valley : valley_starts(problem, scan(sweep, kWideBox))) runs.from(valley);
    runs.from(cheapest(problem, scan(sweep, kIntegralBox), runs.best()->log_cost + kHopeless));
    runs.from(cheapest_island(sweep, problem, runs.best()->log_cost));
}

}  // namespace

std::optional<Found> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report) {
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
    if (has_kinks(problem)) runs.polish();
    return runs.best();
}

}  // namespace tunewright::robust
