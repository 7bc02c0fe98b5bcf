#include "engine/tuning/robust/feasibility.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/sqp.h"
#include "engine/tuning/robust/starts.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

namespace {

constexpr double kPeakTolerance = 1e-5;                     // of ln M: a hundredth of the promised accuracy
constexpr double kLongestTi = 200, kShortestPeakTd = 1e-3;  // multiple of 1/(reference frequency)
constexpr double kUnstableLogPeak = 20;                     // ln of the larger peak for an unstable loop

/// ln of the larger of Ms and Mt, on a grid adapted to the loop, because far from any limit a search's fixed grid may
/// not cover it.
double larger_peak(const DesignProblem& problem, const DesignPoint& x) {
    double largest = 0;
    const bool stable = holds_on_every_loop(problem, to_parallel(controller_at(problem, x)), [&](const auto& loop) {
        const auto peaks = stable_peaks(loop);
        if (peaks) largest = std::max({largest, peaks->S.value, peaks->T.value});
        return peaks.has_value();
    });
    return stable ? std::log(largest) : kUnstableLogPeak;
}

constexpr double kMinExcess = 0.01, kFirstExcess = 0.5, kMaxExcess = 40;  // of peaks over 1, for a start
constexpr double kExcessStep = 1.6;                                       // factor between successive attempts
constexpr double kCloseStart = 1.05;  // multiple of the least excess at which a scan finds a design

/// A stable loop whose peaks exceed 1 by at most `excess`; empty if a scan finds none.
std::optional<DesignPoint> stable_within(DesignProblem problem, double reference, double excess, Stability wanted) {
    problem.limits = PeakLimits{.Ms = 1 + excess, .Mt = 1 + excess, .Mks = std::nullopt, .m_circle = false};
    return first_stable(Sweep(problem, reference), {.Ti_points = 13, .Td_points = 11}, wanted);
}

/// Extent of the search for stable loops.
struct StartSearch {
    double first, max;  // excess
    Stability wanted;
};
// Loops with any peaks are searched if none with usual peaks is found around any reference. Those whose stability the
// sweep's grid does not show come last: most of their gains extend to frequencies at which the dead time turns faster
// than the grid resolves, and none of these is stable.
constexpr StartSearch kStartSearches[] = {{kFirstExcess, kFirstExcess, Stability::inferred},
                                          {kExcessStep * kFirstExcess, kMaxExcess, Stability::inferred},
                                          {kFirstExcess, kMaxExcess, Stability::verified}};

/// Two stable loops: one with the widest limits that were needed, and one with nearly the least peaks that a scan
/// finds. From either one alone a search may stall at the kinks of the larger of two peaks.
std::vector<DesignPoint> stable_starts(const DesignProblem& problem, double reference, const StartSearch& how) {
    const auto within = [&](double excess) { return stable_within(problem, reference, excess, how.wanted); };
    double enough = how.first;
    auto found = within(enough);
    while (!found && enough < how.max) found = within(enough *= kExcessStep);
    if (!found) return {};
    std::vector<DesignPoint> starts = {*found};
    double too_little = enough / kExcessStep;
    const auto look = [&](double excess) {
        const auto point = within(excess);
        (point ? enough : too_little) = excess;
        if (point) found = point;
        return point.has_value();
    };
    if (enough == kFirstExcess)
        while (too_little > kMinExcess && look(too_little)) too_little = enough / kExcessStep;
    while (enough > kCloseStart * too_little) look(std::sqrt(enough * too_little));
    if (*found != starts.front()) starts.push_back(*found);
    return starts;
}

/// Parameters of a descent.
struct Stage {
    double step, tolerance;
};
// Restarted with shorter steps and smaller tolerances, because the larger of two peaks has kinks at which a search
// stalls.
constexpr Stage kFirstStage = {0.4, 100 * kPeakTolerance};
constexpr Stage kLaterStages[] = {{0.1, 10 * kPeakTolerance}, {0.1, kPeakTolerance}};
constexpr double kMinRefinementGain = 0.1;  // of ln M: possible gain of the later stages

/// Descends from `min.x`; M is kUnstableLogPeak if it finds no stable loop.
void descend(MinPeak& min, const DesignProblem& problem, const Stage& stage) {
    const auto n = static_cast<std::size_t>(problem.dimension());
    // The least peak is often at Ti = infinity, where y does not return to the set point, so Ti is limited to that of
    // usual designs.
    const double longest = std::log(kLongestTi / min.reference), shortest = std::log(kShortestPeakTd / min.reference);
    // The unknowns are steps from the centre, because the logarithms themselves depend on the unit of time.
    const auto stepped = [&](const std::vector<double>& step) {
        DesignPoint x = min.x;
        for (std::size_t i = 0; i < n; ++i) x[i] += step[i];
        return x;
    };
    const auto cost = [&](const std::vector<double>& step, bool&) {
        const DesignPoint x = stepped(step);
        const double beyond = std::max(0.0, x[1] - longest) + (n > 2 ? std::max(0.0, shortest - x[2]) : 0);
        return larger_peak(problem, x) + 0.1 * beyond;
    };
    const auto found = find_local_minimum(LocalSearch::subplex, cost, std::vector<double>(n, 0.0),
                                          {.step = std::vector<double>(n, stage.step), .tolerance = stage.tolerance});
    min.x = stepped(found.x);
    min.M = std::exp(found.value);
}

}  // namespace

std::optional<MinPeak> min_common_peak(const DesignProblem& problem) {
    std::vector<double> references = slower_references(problem);
    references.insert(references.begin(), reference_frequency(problem));
    std::vector<MinPeak> valleys;
    for (const StartSearch& how : kStartSearches)
        if (valleys.empty())
            for (const double reference : references)
                for (const DesignPoint& start : stable_starts(problem, reference, how))
                    valleys.push_back({.M = std::exp(kUnstableLogPeak), .x = start, .reference = reference});
    for (MinPeak& valley : valleys) descend(valley, problem, kFirstStage);
    const auto lower = [](const MinPeak& a, const MinPeak& b) { return a.M < b.M; };
    std::ranges::sort(valleys, lower);
    MinPeak min{.M = std::exp(kUnstableLogPeak)};
    for (MinPeak& valley : valleys) {
        if (std::log(valley.M / min.M) > kMinRefinementGain) break;
        for (const Stage& stage : kLaterStages) descend(valley, problem, stage);
        const double won = std::log(min.M / valley.M);
        min = std::min(min, valley, lower);
        if (won < kPeakTolerance) break;  // skip the remaining starts, which are higher than this one
    }
    return min.M < std::exp(kUnstableLogPeak) ? std::optional(min) : std::nullopt;
}

bool has_no_finite_optimum(const DesignProblem& problem) {
    for (std::size_t i = 0; i < problem.others.size(); ++i) {
        DesignProblem alone = problem;
        alone.plant = &problem.others[i];
        alone.others = {};
        if (!has_no_finite_optimum(alone)) return false;
    }
    const LinearPlant& plant = *problem.plant;
    if (plant.dead_time() > 0 || plant.has_right_half_plane_zero() || problem.limits.Mks) return false;
    const int excess = plant.pole_excess();
    // A fixed second-order filter adds one to a PID's pole excess, two to a PI's.
    if (problem.filter.Tf && *problem.filter.Tf > 0) return problem.pid && excess == 0;
    if (excess == 0) return true;
    const bool tied = problem.pid && problem.filter.Tf_over_Td.has_value();
    if (excess > (problem.pid ? 2 : 1)) return false;
    if (excess <= 1 || !tied) return true;
    // Far above every corner the plant is K/s^2: a design that is feasible there is feasible at every higher speed.
    const auto asymptote = LinearPlant::make(Zpk{.K = problem.sign, .zeros = {}, .poles = {0.0, 0.0}, .L = 0});
    DesignProblem limit = problem;
    limit.plant = &*asymptote;
    limit.others = {};
    limit.sign = 1;
    return !scan(Sweep(limit, 1), {.Ti_points = 13, .Td_points = 11}, Stability::verified).empty();
}

namespace {

/// Rounded up to three decimals, as printed.
double rounded_up(double limit) { return std::ceil(limit * 1000) / 1000; }

/// The smallest common limit for which a controller is actually found, from 1 % above the least peak upwards; empty if
/// there is none.
std::optional<double> workable_limit(DesignProblem problem, const MinPeak& min) {
    for (double M = min.M * 1.01; M < 4 * min.M; M = 1 + (M - 1) * 1.1) {
        problem.limits.Ms = problem.limits.Mt = rounded_up(M);
        if (feasible_near(Sweep(problem, min.reference), min.x)) return problem.limits.Ms;
    }
    return std::nullopt;
}

std::string on_plants(const DesignProblem& problem) {
    return problem.others.empty() ? " on this plant"
                                  : " on all " + std::to_string(problem.plants()) + " evaluated plants";
}

}  // namespace

Error why_infeasible(const DesignProblem& problem, const std::optional<MinPeak>& min) {
    const std::string name = problem.pid ? "PID" : "PI";
    if (!min)
        return {ErrorKind::unstable_plant, "",
                "No " + name + " controller was found that stabilises " +
                    (problem.others.empty() ? "this plant" : "all of these plants") +
                    (problem.pid ? ". " : "; a PID might. ") +
                    "Check the signs and the unit of the dead time, or shorten the dead time."};
    const auto workable = workable_limit(problem, *min);
    if (problem.limits.Mks && (!workable || *workable <= std::min(problem.limits.Ms, problem.limits.Mt)))
        return {ErrorKind::no_feasible_controller, "Mks",
                "No " + name + " controller keeps Mks <= " + text(*problem.limits.Mks) +
                    " together with the other limits. Raise Mks or omit it."};
    if (workable && *workable <= std::min(problem.limits.Ms, problem.limits.Mt) && !problem.limits.m_circle)
        return {ErrorKind::numerical_failure, "",
                "Controllers within the limits exist, but their responses could not be computed. Check the units of "
                "the time constants and the dead time: they differ by many orders of magnitude."};
    const double common = workable.value_or(rounded_up(min->M * 1.01));
    const std::string broken = "No " + name + " controller keeps Ms <= " + text(problem.limits.Ms) +
                               " and Mt <= " + text(problem.limits.Mt) + on_plants(problem) +
                               (problem.limits.Mks ? " with Mks <= " + text(*problem.limits.Mks) : std::string());
    if (common > limits::kMaxMs)
        return {ErrorKind::no_feasible_controller, "",
                broken + ", and none was found for any common limit up to " + text(limits::kMaxMs) +
                    ". Shorten the dead time, or stabilise the plant with an inner loop."};
    return {ErrorKind::no_feasible_controller,
            "",
            broken + ". The smallest common limit that works is Ms = Mt = " + text(common) + "; use at least that.",
            {{"Ms", common}, {"Mt", common}}};
}

}  // namespace tunewright::robust
