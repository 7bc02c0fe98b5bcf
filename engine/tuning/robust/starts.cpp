#include "engine/tuning/robust/starts.h"

#include <algorithm>
#include <cmath>

#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {
namespace {

constexpr double kScanTolerance = 1e-3;  // of the simulations that only compare starting points
constexpr int kMaxCompared = 12;
constexpr std::size_t kMaxValleys = 4;
constexpr double kWiderLimits = 1.4;  // times M - 1
constexpr ScanBox kIslandBox = {
    .Ti_points = 12, .Td_points = 12, .Ti_low = 0.01, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 60};

void consider(Candidate& best, const DesignProblem& problem, const DesignPoint& x) {
    if (log_cost_bound(problem, x) >= best.log_cost) return;
    const double cost = log_cost(problem, x, kScanTolerance);
    if (cost < best.log_cost) best = {x, cost};
}

/// The least integrated error Ti/Kp costs sweeps only, and often is next to the optimum (Garpinger and Hagglund 2008;
/// Hast et al. 2013).
DesignPoint least_integrated_error(const Sweep& sweep, DesignProblem problem, const DesignPoint& start) {
    problem.objective = Objective::load_ie;
    SqpOptions options;
    options.cost_tolerance = 1e-4;
    return minimise(sweep, problem, start, options, {}).x;
}

std::optional<Candidate> if_below(const Candidate& best, double below) {
    return best.log_cost < below ? std::optional(best) : std::nullopt;
}

}  // namespace

std::optional<Candidate> best_start(const Sweep& sweep, const DesignProblem& problem,
                                    const std::vector<ScanPoint>& points) {
    const DesignPoint integrated = least_integrated_error(sweep, problem, points.front().x);
    Candidate best;
    if (is_stable(problem, integrated)) consider(best, problem, integrated);
    int compared = 0;
    for (const auto& point : points) {
        if (log_cost_bound(problem, point.x) >= best.log_cost) break;  // the points ascend in it
        if (++compared > kMaxCompared && std::isfinite(best.log_cost)) break;
        consider(best, problem, point.x);
    }
    if (std::isfinite(best.log_cost)) return best;
    // No response settles within the steps allowed (time scales too far apart): the least integrated error still is a
    // design.
    if (feasible_near(sweep, integrated)) return Candidate{integrated, integrated[1] - integrated[0]};
    return std::nullopt;
}

std::vector<Candidate> valley_starts(const DesignProblem& problem, const std::vector<ScanPoint>& points) {
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
    if (starts.size() > kMaxValleys && problem.objective != Objective::load_ie) starts.resize(kMaxValleys);
    return starts;
}

std::optional<Candidate> cheapest(const DesignProblem& problem, const std::vector<ScanPoint>& points, double below) {
    Candidate best{.log_cost = below};
    for (const auto& point : points) consider(best, problem, point.x);
    return if_below(best, below);
}

std::optional<Candidate> cheapest_island(const Sweep& sweep, const DesignProblem& problem, double below) {
    DesignProblem wider = problem;
    for (double* limit : {&wider.limits.Ms, &wider.limits.Mt}) *limit = 1 + (*limit - 1) * kWiderLimits;
    Candidate best{.log_cost = below};
    for (const auto& point : scan(Sweep(wider, sweep.reference()), kIslandBox)) {
        if (log_cost_bound(problem, point.x) >= best.log_cost) continue;
        if (const auto inside = feasible_near(sweep, point.x)) consider(best, problem, *inside);
    }
    return if_below(best, below);
}

}  // namespace tunewright::robust
