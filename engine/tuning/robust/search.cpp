#include "engine/tuning/robust/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/numerics/optimise/direct_search.h"
#include "engine/plant/linear/resonance.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/known_start.h"
#include "engine/tuning/robust/starts.h"

namespace tunewright::robust {

namespace {

/// In units of ln of the cost or of a logarithm of the unknowns, unless stated otherwise. The values were found with
/// `bench/robust_search`, which compares this search with the best known design of random plants
/// (tests/engine/tuning/random_plants.h: 300 for a first test, thousands if a constant matters for one plant in a
/// hundred) for every objective; `bench/robust_batch` measures the time. To tune a constant: change it, run both, and
/// keep the change if the worst plant improves or the median is faster, and no plant is lost.
struct FastSearchConstants {
    double slow_zero = 0.3;            ///< multiple of the reference: a filter below such a zero may give another local
                                       ///< minimum
    double short_Td = 0.1;             ///< multiple of 1/reference: below it the cost hardly depends on ln Td
    double known_radius = 0.1;         ///< first trust region about a start that is nearly the optimum
    double same_design = 0.02;         ///< in each logarithm: two ends closer than this are equal
    double same_valley = 0.1;          ///< in each logarithm: a rough run this close to an end leads to it
    double hopeless_cost = 0.7;        ///< a start this much costlier than the best is skipped
    double rough_tolerance = 3e-3;     ///< of a run that only estimates the cost of a local minimum
    double worth_following = 0.02;     ///< a rough run's end may be this much costlier and still lead to the best
                                       ///< minimum
    double polish_tolerance = 1e-4;    ///< of a simplex
    double polish_step = 0.05;         ///< its first
    int max_polish_evaluations = 50;   ///< of one simplex
    int trial_polish_evaluations = 8;  ///< of the first one without a set-point step: of 2,800 random resonant plants,
                                       ///< none that had gained less than `worth_another` in eight steps gained it
                                       ///< later
    int max_simplices = 10;
    double worth_another = 5e-4;  ///< gain of a simplex for which another one follows
    double beyond_lag = 2;        ///< multiple of the slowest lag: a Ti that cancels it lies inside the scan
};
constexpr FastSearchConstants k;

/// The regions of the scans, in 1/reference; the usual one is `ScanBox{}`. Each was added for plants on which the
/// others missed the best known design: bench/robust_search lists them (`above 0.1 %`).
struct ScanBoxes {
    /// A PI on two slow lags, or on one and an integrator, is much slower than a PID would be.
    ScanBox slow = {.Ti_low = 60, .Ti_high = 1000};
    /// The usual region with a finer spacing, for a feasible set that is smaller than the usual spacing.
    ScanBox close = {.Ti_points = 27, .Td_points = 21};
    /// Local minima of a resonant plant. Its optimum may be an ordinary design, or integral action alone with a filter
    /// that removes the resonance: short Ti, long Td.
    ScanBox wide = {.Ti_points = 9, .Td_points = 8, .Ti_low = 0.01, .Ti_high = 60, .Td_low = 0.02, .Td_high = 60};
    /// Nearly pure integral action, for which Td only sets the filter.
    ScanBox integral = {.Ti_points = 1, .Td_points = 8, .Ti_low = 1e-4, .Ti_high = 1e-4, .Td_low = 1, .Td_high = 250};
    /// Integral action with a filter that is long compared with 1/reference, as a slow zero may need it.
    ScanBox filtered = {.Ti_points = 4, .Td_points = 4, .Ti_low = 0.05, .Ti_high = 2, .Td_low = 10, .Td_high = 250};
    /// A loop with so high a gain that a set-point step hardly needs the integral.
    ScanBox long_Ti = {.Ti_points = 4, .Td_points = 5, .Ti_low = 40, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 2};
};
constexpr ScanBoxes kBoxes;

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

/// For a stable plant without zeros the feasible designs are connected through those of low gain, which keep every
/// limit: of some 6000 random ones none had a separate set.
bool may_have_islands(const LinearPlant& plant) {
    return plant.integrators() != 0 || !plant.zeros().empty() ||
           std::ranges::any_of(plant.poles(), [](std::complex<double> pole) { return pole.real() >= 0; });
}

/// On either side of a slow zero, the optimum may need a filter that keeps the loop slower than the zero.
bool has_slow_zero(const DesignProblem& problem, double reference) {
    return problem.plant != nullptr && std::ranges::any_of(problem.plant->zeros(), [&](std::complex<double> zero) {
               return std::abs(zero) < k.slow_zero * reference;
           });
}

bool has_kinks(const DesignProblem& problem) {
    return has_setpoint(problem) || (problem.objective == Objective::load_iae && has_resonant_plant(problem));
}

double short_Td(const Sweep& sweep) { return std::log(k.short_Td / sweep.reference()); }

/// Runs of the sequential quadratic programming from several starts; the cheapest design is the result.
class Runs {
public:
    Runs(const Sweep& sweep, const DesignProblem& problem, const Report& report)
        : sweep_(sweep), problem_(problem), report_(report) {}

    /// Runs from one start; a start without a settled response has no effect.
    void from(const std::optional<Candidate>& start) {
        if (start && !stopped()) run(*start, {.stable_start = start->stable}, &Runs::at_known_end);
    }

    /// The same for a local minimum that is probably not the best: it is followed to its end only if it may be.
    void explore(const std::optional<Candidate>& start) {
        if (!start || stopped() || in_known_valley(start->x)) return;
        const double before = best_ ? best_->log_cost : kLogCostOfNoDesign;
        const SqpResult rough = run(
            *start,
            {.cost_tolerance = k.rough_tolerance, .stable_start = start->stable, .wanted = before + k.worth_following},
            &Runs::in_known_valley);
        if (stopped() || !rough.converged || rough.log_cost > before + k.worth_following) return;
        ends_.pop_back();
        run({rough.x, rough.log_cost, rough.stable}, {.stable_start = rough.stable, .curvature = rough.curvature},
            &Runs::at_known_end);
    }

    /// Refines the best design by simplices: the integral of |e| has kinks where a slow tail after a set-point step, or
    /// an oscillation of a resonance, begins to change the sign of e, and a descent along smooth models stalls at them.
    void polish() {
        for (int round = 0; round < k.max_simplices && best_ && !stopped(); ++round) {
            const double before = best_->log_cost;
            simplex(round > 0 || has_setpoint(problem_) ? k.max_polish_evaluations : k.trial_polish_evaluations);
            if (before - best_->log_cost < k.worth_another) break;
        }
    }

    bool stopped() const { return best_ && best_->stopped; }
    const std::optional<DesignResult>& best() const { return best_; }

private:
    /// `arrived`: true if further runs from here would find nothing new.
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

    void simplex(int max_evaluations) {
        const DesignPoint start = best_->x;
        // The unknowns are steps from the start, because the logarithms themselves depend on the unit of time.
        const auto cost = [&](const std::vector<double>& step, bool& stop) {
            DesignPoint x = start;
            for (std::size_t i = 0; i < step.size(); ++i) x[i] += step[i];
            const auto feasible = feasible_near(sweep_, x);
            if (!feasible) return kLogCostOfNoDesign;
            const double value =
                std::min(kLogCostOfNoDesign, log_cost(problem_, *feasible, SqpOptions{}.simulation_tolerance));
            if (value < best_->log_cost)
                take({*feasible, value, report_ && !report_(*feasible, value), best_->curvature});
            stop = stopped();
            return value;
        };
        const auto n = static_cast<std::size_t>(problem_.dimension());
        find_local_minimum(LocalSearch::nelder_mead, cost, std::vector<double>(n, 0.0),
                           {.step = std::vector<double>(n, k.polish_step),
                            .tolerance = k.polish_tolerance,
                            .max_evaluations = max_evaluations});
    }

    void take(const DesignResult& found) {
        const bool stop = found.stopped || stopped();
        if (!best_ || found.log_cost < best_->log_cost) best_ = found;
        best_->stopped = stop;
    }

    bool at_known_end(const DesignPoint& x) const { return known(x, k.same_design); }
    bool in_known_valley(const DesignPoint& x) const { return known(x, k.same_valley); }

    /// True if an end is near in all logarithms; all short Td count as equal.
    bool known(const DesignPoint& x, double same) const {
        const double min_Td = short_Td(sweep_);
        return std::ranges::any_of(ends_, [&](const DesignPoint& end) {
            return std::abs(x[0] - end[0]) <= same && std::abs(x[1] - end[1]) <= same &&
                   std::abs(std::max(x[2], min_Td) - std::max(end[2], min_Td)) <= same;
        });
    }

    const Sweep& sweep_;
    const DesignProblem& problem_;
    const Report& report_;
    std::vector<DesignPoint> ends_;
    std::optional<DesignResult> best_;
};

/// A run may end at a short Td only because the cost is flat there: it is compared with the least Td and with a long
/// one.
void look_beyond_short_Td(Runs& runs, const Sweep& sweep, const DesignProblem& problem, std::vector<ScanPoint> points) {
    const double shortest = std::log(kMinTd / sweep.reference()), ordinary = short_Td(sweep);
    const DesignPoint end = runs.best()->x;
    if (end[2] > ordinary) return;
    const DesignPoint nearly_PI = {end[0], end[1], shortest};
    runs.from(Candidate{.x = nearly_PI, .stable = sweep.stays_stable(end, nearly_PI)});
    std::erase_if(points, [&](const ScanPoint& point) { return point.x[2] <= ordinary; });
    runs.from(lowest_cost(problem, points));
}

/// A Ti that cancels the slowest lag lies inside.
ScanBox long_Ti_box(const DesignProblem& problem, double reference) {
    ScanBox box = kBoxes.long_Ti;
    const double spacing = std::pow(box.Ti_high / box.Ti_low, 1.0 / (box.Ti_points - 1));
    if (problem.plant != nullptr)
        for (const auto pole : problem.plant->poles())
            if (pole != 0.0) box.Ti_high = std::max(box.Ti_high, k.beyond_lag * reference / std::abs(pole));
    box.Ti_points = 1 + static_cast<int>(std::ceil(std::log(box.Ti_high / box.Ti_low) / std::log(spacing)));
    return box;
}

/// If a long Ti is better than the start, kinks lie so close together that one run rarely ends at the best one.
void look_at_long_Ti(Runs& runs, const Sweep& sweep, const DesignProblem& problem) {
    const auto points = scan(sweep, long_Ti_box(problem, sweep.reference()));
    const double before = runs.best()->log_cost;
    const auto best = lowest_cost(problem, points, before + k.hopeless_cost);
    runs.from(best);
    if (!best || best->log_cost >= before) return;
    for (const auto& start : valley_starts(problem, points))
        if (start.log_cost < before + k.hopeless_cost) runs.from(start);
}

void look_for_valleys(Runs& runs, const Sweep& sweep, const DesignProblem& problem,
                      const std::vector<ScanPoint>& points) {
    // A limit on |C S| is a compromise between gain and filtering, with several local minima along Td.
    if (problem.limits.Mks)
        for (const auto& valley : valley_starts(problem, points)) runs.from(valley);
    if (has_setpoint(problem)) look_at_long_Ti(runs, sweep, problem);
    const auto look_in = [&](const ScanBox& box) {
        runs.explore(lowest_cost(problem, scan(sweep, box), runs.best()->log_cost + k.hopeless_cost));
    };
    if (!has_resonant_plant(problem)) {
        if (has_slow_zero(problem, sweep.reference())) look_in(kBoxes.filtered);
        return;
    }
    const double hopeless = runs.best()->log_cost + k.hopeless_cost;
    for (const auto& valley :
         valley_starts(problem, scan(sweep, kBoxes.wide, Stability::inferred, hopeless), short_Td(sweep)))
        runs.explore(valley);
    look_in(kBoxes.integral);
    if (any_plant(problem, may_have_islands)) runs.explore(lowest_cost_island(sweep, problem, runs.best()->log_cost));
}

/// From where the optimum is known to be nearly, one run without a scan; empty if it did not converge, or ended where
/// the cost is flat.
std::optional<DesignResult> from_known_start(const Sweep& sweep, const DesignProblem& problem, const Report& report) {
    const auto start = known_start(problem);
    if (!start) return std::nullopt;
    bool stopped = false;
    const Report watch = [&](const DesignPoint& x, double cost) {
        stopped = report && !report(x, cost);
        return !stopped;
    };
    const SqpResult found = minimise(sweep, problem, *start, {.trust_radius = k.known_radius}, watch);
    if (!std::isfinite(found.log_cost) || !(found.converged || stopped)) return std::nullopt;
    if (problem.pid && found.x[2] <= short_Td(sweep)) return std::nullopt;
    return DesignResult{found.x, found.log_cost, stopped, found.curvature};
}

}  // namespace

std::optional<DesignResult> fast_search(const Sweep& sweep, const DesignProblem& problem, const Report& report) {
    if (auto found = from_known_start(sweep, problem, report)) return found;
    std::vector<ScanPoint> points;
    for (const ScanBox& box : {ScanBox{}, kBoxes.slow, kBoxes.close})
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

/// Constants of the paper's searches in the (Ti, Td) plane.
struct PlaneSearchConstants {
    double simulation_tolerance = 1e-4;
    double simplex_corner = 0.4;  ///< corner of the simplex relative to the first one (Garpinger and Hägglund 2008,
                                  ///< section 4.2)
    int grid_points = 25;         ///< a side
    double grid_reach = 3;        ///< in ln: a factor of 20 to either side
    int grid_rounds = 4;
    double grid_finer = 6;         ///< ratio of successive rounds: the next one covers two cells
    int max_tightening_steps = 4;  ///< Newton's, in ln Kp
    double near_limit = -0.05;     ///< ln of a peak: a lower peak does not end a gap
    double min_slope = 1e-3;       ///< of a peak over ln Kp: a flatter one is not moved by the gain
    double aim_below = 1e-8;       ///< in ln of a peak: aims inside the limit
    double min_step = 1e-10;       ///< of ln Kp: changes nothing any more
    double max_step = 0.1;         ///< in ln Kp: a longer step would leave the neighbourhood of the interval's end
    double no_Td = 1e-300;         ///< in place of Td = 0, because its logarithm does not exist
};
constexpr PlaneSearchConstants kPlane;

/// Newton's method in ln(Kp), from the tangency on the grid to that of the refined peak.
void tighten(const Sweep& sweep, DesignPoint& x, bool upper_end) {
    for (int i = 0; i < kPlane.max_tightening_steps; ++i) {
        const auto peaks = sweep.peaks(x, kPlane.near_limit);
        if (peaks.empty()) return;
        const ActivePeak* limit = nullptr;
        for (const auto& peak : peaks)
            if ((peak.gradient[0] > 0) == upper_end) {
                limit = &peak;
                break;
            }
        if (limit == nullptr || std::abs(limit->gradient[0]) < kPlane.min_slope) return;
        const double step = -(limit->value + kPlane.aim_below) / limit->gradient[0];
        if (std::abs(step) < kPlane.min_step || std::abs(step) > kPlane.max_step) return;
        x[0] += step;
    }
}

/// The cheapest feasible gain for one (Ti, Td), moved exactly onto the limit; empty if no gain is feasible.
std::optional<DesignResult> best_gain(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td) {
    std::optional<DesignResult> best;
    const auto gains = feasible_gains(sweep, Ti, Td);
    for (std::size_t i = 0; i < gains.size(); ++i) {
        DesignPoint x = {std::log(gains[i].Kp), std::log(Ti), problem.pid ? std::log(Td) : 0};
        tighten(sweep, x, i % 2 == 0);  // the ends of a gap alternate, beginning with the upper one
        if (best && log_cost_bound(problem, x) >= best->log_cost) continue;
        const auto peaks = sweep.peaks(x, kPlane.near_limit);
        // Between the grid's points the gap is closed after all.
        if (!peaks.empty() && peaks[0].value > limits::kMaxRelativeExcessFound) continue;
        const double cost = log_cost(problem, x, kPlane.simulation_tolerance);
        if (std::isfinite(cost) && (!best || cost < best->log_cost)) best = DesignResult{x, cost, false};
    }
    return best;
}

struct PlaneSearch {
    const Sweep* sweep;
    const DesignProblem* problem;
    const Report* report;
    std::optional<DesignResult> best;

    double cost(double log_Ti, double log_Td) {
        const auto found = best_gain(*sweep, *problem, std::exp(log_Ti), std::exp(log_Td));
        if (!found) return kLogCostOfNoDesign;
        if (!best || found->log_cost < best->log_cost) {
            best = found;
            best->stopped = *report && !(*report)(found->x, found->log_cost);
        }
        return found->log_cost;
    }
    bool stopped() const { return best && best->stopped; }
};

}  // namespace

std::optional<DesignResult> nelder_mead_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                               const Report& report) {
    PlaneSearch search{&sweep, &problem, &report, std::nullopt};
    // The unknowns are steps from the first corner, because the logarithms themselves depend on the unit of time.
    const auto cost = [&](const std::vector<double>& step, bool& stop) {
        const double value = search.cost(std::log(Ti) + step[0], problem.pid ? std::log(Td) + step[1] : 0);
        stop = search.stopped();
        return value;
    };
    const std::size_t n = problem.pid ? 2 : 1;
    find_local_minimum(LocalSearch::nelder_mead, cost, std::vector<double>(n, 0.0),
                       {.step = std::vector<double>(n, std::log(kPlane.simplex_corner))});
    return search.best;
}

std::optional<DesignResult> grid_search(const Sweep& sweep, const DesignProblem& problem, double Ti, double Td,
                                        CostSurface* surface, const Report& report) {
    PlaneSearch search{&sweep, &problem, &report, std::nullopt};
    double centre_Ti = std::log(Ti), centre_Td = std::log(std::max(Td, kPlane.no_Td)), reach = kPlane.grid_reach;
    const int Td_points = problem.pid ? kPlane.grid_points : 1;
    for (int round = 0; round < kPlane.grid_rounds; ++round, reach /= kPlane.grid_finer) {
        const auto at = [&](double centre, int i, int n) {
            return n == 1 ? centre : centre + reach * (2.0 * i / (n - 1) - 1);
        };
        for (int i = 0; i < kPlane.grid_points; ++i) {
            if (surface != nullptr && round == 0) {
                surface->Ti.push_back(std::exp(at(centre_Ti, i, kPlane.grid_points)));
                surface->cost.emplace_back();
            }
            for (int j = 0; j < Td_points; ++j) {
                const double log_cost = search.cost(at(centre_Ti, i, kPlane.grid_points), at(centre_Td, j, Td_points));
                if (search.stopped()) return search.best;
                if (surface == nullptr || round != 0) continue;
                if (i == 0) surface->Td.push_back(problem.pid ? std::exp(at(centre_Td, j, Td_points)) : 0);
                surface->cost.back().push_back(log_cost < kLogCostOfNoDesign ? std::optional<double>(std::exp(log_cost))
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
