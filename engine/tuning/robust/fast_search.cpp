#include "engine/tuning/robust/fast_search.h"

#include <cmath>
#include <limits>

#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kScanTolerance = 1e-3;  // of the simulations that only compare starting points
constexpr int kMostCompared = 12;

struct Candidate {
    Point x{};
    double log_cost = std::numeric_limits<double>::infinity();
};

void consider(Candidate& best, const Problem& problem, const Point& x) {
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

}  // namespace

std::optional<Found> fast_search(const Sweep& sweep, const Problem& problem, const Report& report) {
    std::vector<ScanPoint> points = scan(sweep);
    if (points.empty()) points = scan(sweep, 27, 21);
    if (points.empty()) return std::nullopt;
    Candidate best;
    const Point integrated = least_integrated_error(sweep, problem, points.front().x);
    if (is_stable(problem, integrated)) consider(best, problem, integrated);
    const bool bounded = problem.objective == Objective::load_iae;
    int compared = 0;
    for (const auto& point : points) {
        if (bounded && point.log_ie >= best.log_cost) break;
        if (++compared > kMostCompared && std::isfinite(best.log_cost)) break;
        consider(best, problem, point.x);
    }
    if (!std::isfinite(best.log_cost)) {
        // No response settles within the steps allowed (time scales too far apart): the least integrated error still is
        // a design.
        if (!feasible_near(sweep, integrated)) return std::nullopt;
        return Found{integrated, integrated[1] - integrated[0], false};
    }
    bool stopped = false;
    const Report watch = [&](const Point& x, double cost) {
        stopped = report && !report(x, cost);
        return !stopped;
    };
    const SqpResult result = minimise(sweep, problem, best.x, {}, watch);
    return Found{result.x, result.log_cost, stopped};
}

}  // namespace tunewright::robust
