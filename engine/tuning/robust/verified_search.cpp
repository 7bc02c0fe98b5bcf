#include "engine/tuning/robust/verified_search.h"
#include "engine/plant/linear/resonance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/best_so_far.h"
#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/search.h"
#include "engine/tuning/robust/sqp.h"
#include "engine/tuning/robust/starts.h"

namespace tunewright::robust {

namespace {

DesignProblem tightened(DesignProblem problem, double relative) {
    problem.limits.Ms = 1 + (problem.limits.Ms - 1) * (1 - relative);
    problem.limits.Mt = 1 + (problem.limits.Mt - 1) * (1 - relative);
    if (problem.limits.Mks) *problem.limits.Mks *= 1 - relative;
    return problem;
}

class ProgressReport {
public:
    ProgressReport(const DesignProblem& problem, const RunControl& control) : problem_(problem), control_(control) {}

    bool operator()(const DesignPoint& x, double log_cost) {
        ++steps_;
        if (control_.progress) {
            Progress progress;
            progress.fraction = 1 - std::pow(0.9, steps_);
            progress.stage = "tune";
            progress.message = "robust design: " + std::to_string(steps_) + " improvements so far.";
            BestSoFar best{controller_at(problem_, x), std::exp(log_cost), problem_.limits.Ms, problem_.limits.Mt};
            // For other objectives the integral of e stands for the load IAE, and is never larger.
            if (problem_.objective != Objective::load_iae) best.load_IAE = std::exp(x[1] - x[0]);
            progress.best = std::make_shared<const BestSoFar>(best);
            control_.progress(progress);
        }
        return !control_.stop.stop_requested();
    }

private:
    const DesignProblem& problem_;
    const RunControl& control_;
    int steps_ = 0;
};

std::optional<DesignResult> search(SearchKind kind, const Sweep& sweep, const DesignProblem& problem, PlaneStart start,
                                   CostSurface* surface, const Report& report) {
    if (kind == SearchKind::fast && surface == nullptr) return fast_search(sweep, problem, report);
    if (!start || feasible_gains(sweep, start->first, start->second).empty()) {
        const auto points = scan(sweep);
        if (points.empty()) return std::nullopt;
        start = {std::exp(points.front().x[1]), problem.pid ? std::exp(points.front().x[2]) : 0};
    }
    if (kind == SearchKind::nelder_mead) return nelder_mead_search(sweep, problem, start->first, start->second, report);
    auto gridded = grid_search(sweep, problem, start->first, start->second, surface, report);
    return kind == SearchKind::grid || (gridded && gridded->stopped) ? gridded : fast_search(sweep, problem, report);
}

/// Searches the optima of the two parts of the weighted objective, which are its references. False: no controller meets
/// the limits.
bool has_reference_optima(DesignProblem& problem, const Sweep& sweep) {
    if (problem.objective != Objective::weighted) return true;
    std::vector<DesignPoint> optima;
    for (const Objective part : {Objective::load_iae, Objective::setpoint_iae}) {
        DesignProblem alone = problem;
        alone.objective = part;
        alone.optimal_for_part = {};
        const auto found = fast_search(sweep, alone, {});
        if (!found) return false;
        (part == Objective::load_iae ? problem.load_optimum : problem.setpoint_optimum) = std::exp(found->log_cost);
        optima.push_back(found->x);
    }
    problem.optimal_for_part = std::move(optima);
    return true;
}

/// If no controller stabilises with the sign of Kp, the other sign is tried and then set in `problem`.
std::optional<MinPeak> min_peak_of_either_sign(DesignProblem& problem) {
    if (const auto min = min_common_peak(problem)) return min;
    DesignProblem other = problem;
    other.sign = -problem.sign;
    const auto min = min_common_peak(other);
    if (min) problem.sign = other.sign;
    return min;
}

/// If the scan found nothing, the feasible set may be a small one around the least peak.
std::optional<DesignResult> search_from(const MinPeak& min, DesignProblem& problem, const Report& report) {
    const Sweep sweep(problem, min.reference);
    const auto start = feasible_near(sweep, min.x);
    if (!start) return std::nullopt;
    const SqpResult result = minimise(sweep, problem, *start, {}, report);
    if (!std::isfinite(result.log_cost)) return std::nullopt;
    problem.reference = min.reference;
    return DesignResult{result.x, result.log_cost, false, result.curvature};
}

constexpr double kMaxShortLagRatio = 0.01;      // relative to the dead time
constexpr double kTrustInOtherCurvature = 0.1;  // share of the decrease predicted by the curvature for another limit
                                                // that is trusted

/// With lags so short compared with the dead time, a derivative gains hardly anything and has local minima with a high
/// cost.
bool all_dead_time(const DesignProblem& problem) {
    if (problem.plant == nullptr || problem.plant->integrators() > 0) return false;
    double lags = 0;
    for (const auto pole : problem.plant->poles()) lags += 1 / std::abs(pole);
    return lags < kMaxShortLagRatio * problem.plant->dead_time();
}

/// Searches from a design for fewer plants or another limit; empty if it cannot be moved within the limits.
std::optional<DesignResult> search_again(const Sweep& sweep, const DesignProblem& problem, const DesignResult& before,
                                         const Report& report) {
    const auto start = feasible_near(sweep, before.x);
    if (!start) return std::nullopt;
    bool stopped = false;
    const Report watch = [&](const DesignPoint& x, double cost) {
        stopped = report && !report(x, cost);
        return !stopped;
    };
    SqpOptions options{.stable_start = true};
    if (before.curvature && !all_dead_time(problem)) {
        options.curvature = before.curvature;
        options.cost_tolerance *= kTrustInOtherCurvature;
    }
    const SqpResult result = minimise(sweep, problem, *start, options, watch);
    if (!std::isfinite(result.log_cost)) return std::nullopt;
    return DesignResult{result.x, result.log_cost, stopped, result.curvature ? result.curvature : before.curvature};
}

constexpr int kRounds = 4;               // searches with tighter limits
constexpr double kMinTightening = 1e-6;  // of ln M - 1: the least tightening that changes a design
constexpr double kMaxTightening = 0.5;

constexpr double kExactRunTolerance = 1e-5;    // tolerance of simulations that compare two designs
constexpr double kShortestTd = 1.01 * kMinTd;  // Td times the reference frequency: a smaller one is at its lower end

/// The search and its verification. `promising`: a search from the usual starts may succeed. `explain`: if nothing is
/// found, search more thoroughly, and give the reason.
Expected<DesignResult> checked_search(SearchKind kind, const Sweep& sweep, DesignProblem& problem, bool promising,
                                      const PlaneStart& start, CostSurface* surface, const RunControl& control,
                                      const DesignResult* before, bool explain = true) {
    ProgressReport progress(problem, control);
    const Report report = [&](const DesignPoint& x, double cost) { return progress(x, cost); };
    std::optional<DesignResult> found;
    if (promising && before != nullptr) found = search_again(sweep, problem, *before, report);
    if (promising && !found) found = search(kind, sweep, problem, start, surface, report);
    if (control.stop.stop_requested() && !found)
        return Error{ErrorKind::cancelled, "", "The search was stopped before a feasible controller was found."};
    if (!found && !explain) return Error{ErrorKind::no_feasible_controller, "", "No design was found here."};
    if (!found) {
        const auto min = min_peak_of_either_sign(problem);
        if (min) found = search_from(*min, problem, report);
        if (!found) return why_infeasible(problem, min);
    }
    double tighter = 0;
    for (int round = 0; round < kRounds; ++round) {
        const double excess = worst_excess(problem, found->x);
        if (excess <= limits::kMaxRelativeExcessFound) return *found;
        if (!std::isfinite(excess) || round + 1 == kRounds) break;
        tighter += 1.5 * excess * problem.limits.Ms / (problem.limits.Ms - 1) + kMinTightening;
        const DesignProblem narrowed = tightened(problem, std::min(tighter, kMaxTightening));
        const Sweep narrow_sweep(narrowed, reference_frequency(problem));
        const auto again = minimise(narrow_sweep, narrowed, restore(narrow_sweep, found->x).value_or(found->x),
                                    {.curvature = found->curvature}, {});
        found->x = again.x;
        found->log_cost = again.log_cost;
    }
    return Error{ErrorKind::numerical_failure, "",
                 "The design found does not hold its limits on the independent frequency grid, so it is not returned. "
                 "Use a filter with a longer time constant Tf; for a single design another search may succeed."};
}

/// Also tries a PI in place of the PID. The PI may be better if Td is at its lower end, or if the dead time is much
/// longer than the lags, because the dead time repeats the effect of the derivative. It is also the result if no PID
/// passes the verification.
Expected<DesignResult> or_without_derivative(Expected<DesignResult> found, const DesignProblem& problem,
                                             double reference, const RunControl& control, const DesignResult* before) {
    if (!problem.pid || (found && found->stopped)) return found;
    const bool at_end = found && std::exp(found->x[2]) * reference <= kShortestTd;
    const bool doubtful = found ? at_end || all_dead_time(problem) : found.error().kind == ErrorKind::numerical_failure;
    if (!doubtful) return found;
    DesignProblem without = problem;
    without.pid = false;
    without.optimal_for_part = {};  // a PI with these times need not be stable
    const Sweep sweep(without, reference);
    // A PID whose Td is at its lower end is as good as a PI. With set-point steps or a limit on |C S|, the PI may have
    // another local minimum.
    const bool as_good =
        at_end && !all_dead_time(problem) && problem.objective == Objective::load_iae && !problem.limits.Mks;
    const DesignResult* nearest = before != nullptr ? before : as_good ? &*found : nullptr;
    const DesignResult near =
        nearest != nullptr ? DesignResult{.x = {nearest->x[0], nearest->x[1], 0}} : DesignResult{};
    auto other = checked_search(SearchKind::fast, sweep, without, true, std::nullopt, nullptr, control,
                                nearest != nullptr ? &near : nullptr);
    if (!other) return found;
    // The costs of the two may differ by less than the error of the search's simulations.
    const auto exactly = [](const DesignProblem& one, const DesignResult& design) {
        const double cost = log_cost(one, design.x, kExactRunTolerance);
        return std::isfinite(cost) ? cost : design.log_cost;
    };
    if (found && exactly(problem, *found) <= exactly(without, *other)) return found;
    other->x[2] = -INFINITY;
    return other;
}

constexpr double kSlowReferenceRatio = 0.1;          // multiple of the reference, if nothing is found around it
constexpr double kMaxTiRatio = 30, kMaxTdRatio = 8;  // relative to the reference: near the ends of the scan
constexpr double kResonantRangeFactor = 8;           // multiple of these, for the local minima of a resonant plant
constexpr double kUsualTiRatio = 10;                 // relative to the reference of a loop with limits this tight
constexpr int kMaxReferenceMoves = 3;                // changes of the reference
constexpr double kMinLogCostGainOfMove = 1e-3;       // decrease of ln of the cost

/// The frequency of a loop whose design lies beyond the scanned box; empty if it lies inside.
std::optional<double> reference_of(const DesignResult& found, const DesignProblem& problem) {
    if (problem.measured) return std::nullopt;
    const double reference = reference_frequency(problem), Ti = std::exp(found.x[1]);
    const double wide = problem.pid && is_resonant(*problem.plant) ? kResonantRangeFactor : 1;
    if (problem.pid && std::isfinite(found.x[2]) && std::exp(found.x[2]) * reference > wide * kMaxTdRatio)
        return 1 / std::exp(found.x[2]);
    return Ti * reference > wide * kMaxTiRatio ? std::optional(kUsualTiRatio / Ti) : std::nullopt;
}

/// Replaces the result by `other` and its problem if that is cheaper; returns whether the attempt was worthwhile.
bool take_better(Expected<DesignResult>& found, DesignProblem& problem, Expected<DesignResult> other,
                 const DesignProblem& posed) {
    if (!other) return false;
    // For a weighted cost each reference has its own reference optima.
    const bool own_scale = problem.objective == Objective::weighted;
    const double standing = !found      ? INFINITY
                            : own_scale ? log_cost(posed, found->x, kExactRunTolerance)
                                        : found->log_cost;
    const bool stopped = other->stopped;
    if (!found || other->log_cost < standing) {
        found = std::move(other);
        problem = posed;
    }
    found->stopped = stopped;
    return found->log_cost < standing - kMinLogCostGainOfMove;
}

}  // namespace

Expected<DesignResult> verified_search(SearchKind kind, DesignProblem& problem, const PlaneStart& start,
                                       CostSurface* surface, const RunControl& control, const DesignResult* before) {
    if (!problem.reference) problem.reference = reference_frequency(problem);
    // A design without derivative cannot be a start for one with it.
    const DesignResult* near = before != nullptr && (!problem.pid || std::isfinite(before->x[2])) ? before : nullptr;
    const auto about = [&](DesignProblem& posed, CostSurface* drawn, bool explain) {
        const Sweep sweep(posed, reference_frequency(posed));
        const bool promising = has_reference_optima(posed, sweep);
        return or_without_derivative(
            checked_search(kind, sweep, posed, promising, start, drawn, control, near, explain), posed,
            sweep.reference(), control, before);
    };
    auto found = about(problem, surface, false);
    const auto over = [&] { return control.stop.stop_requested() || (found && found->stopped); };
    const auto look_at = [&](double reference) {
        DesignProblem moved = problem;
        moved.reference = reference;
        auto other = about(moved, nullptr, false);
        return take_better(found, problem, std::move(other), moved);
    };
    for (const double reference : slower_references(problem))
        if (!over()) look_at(reference);
    if (!found) {
        // If the scans found nothing, there may be a small feasible set around the least peak.
        DesignProblem usual = problem;
        if (!over() && !problem.measured) look_at(kSlowReferenceRatio * reference_frequency(problem));
        auto last = about(usual, surface, true);
        if (!found && !last) return last;
        take_better(found, problem, std::move(last), usual);
    }
    for (int moves = 0; found && moves < kMaxReferenceMoves && !over() && before == nullptr; ++moves) {
        const auto reference = reference_of(*found, problem);
        if (!reference || !look_at(*reference)) break;
    }
    return found;
}

}  // namespace tunewright::robust
