#include "engine/tuning/robust/fast_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kScanTolerance = 1e-3;  // of the simulations that only compare starting points
constexpr int kMostCompared = 12;
constexpr std::size_t kMostValleys = 4;

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

/// Under a limit on |C S| the cost has several valleys along Td, where gain is traded against filtering: the cheapest
/// point of each Td.
std::vector<Candidate> valley_starts(const Problem& problem, const std::vector<ScanPoint>& points) {
    std::vector<Candidate> starts;
    for (const auto& point : points) {
        const auto same_Td = [&](const Candidate& c) { return std::abs(c.x[2] - point.x[2]) < 1e-9; };
        auto at = std::find_if(starts.begin(), starts.end(), same_Td);
        if (at == starts.end()) at = starts.insert(starts.end(), Candidate{point.x});
        if (point.log_ie < at->log_cost) consider(*at, problem, point.x);
    }
    std::erase_if(starts, [](const Candidate& c) { return !std::isfinite(c.log_cost); });
    std::sort(starts.begin(), starts.end(),
              [](const Candidate& a, const Candidate& b) { return a.log_cost < b.log_cost; });
    if (starts.size() > kMostValleys) starts.resize(kMostValleys);
    return starts;
}

/// The cheapest of the least integrated error and the scan's points; empty if no response settles.
std::vector<Candidate> best_start(const Sweep& sweep, const Problem& problem, const std::vector<ScanPoint>& points,
                                  const Point& integrated) {
    Candidate best;
    if (is_stable(problem, integrated)) consider(best, problem, integrated);
    const bool bounded = problem.objective == Objective::load_iae;
    int compared = 0;
    for (const auto& point : points) {
        if (bounded && point.log_ie >= best.log_cost) break;
        if (++compared > kMostCompared && std::isfinite(best.log_cost)) break;
        consider(best, problem, point.x);
    }
    if (std::isfinite(best.log_cost)) return {best};
    // No response settles within the steps allowed (time scales too far apart): the least integrated error still is a
    // design.
    if (feasible_near(sweep, integrated)) return {Candidate{integrated, integrated[1] - integrated[0]}};
    return {};
}

}  // namespace

std::optional<Found> fast_search(const Sweep& sweep, const Problem& problem, const Report& report) {
    std::vector<ScanPoint> points = scan(sweep);
    if (points.empty()) points = scan(sweep, 27, 21);
    if (points.empty()) return std::nullopt;
    std::vector<Candidate> starts =
        best_start(sweep, problem, points, least_integrated_error(sweep, problem, points.front().x));
    if (problem.limits.Mks && problem.pid)
        for (const auto& valley : valley_starts(problem, points)) starts.push_back(valley);
    std::optional<Found> best;
    for (const auto& start : starts) {
        bool stopped = false;
        const Report watch = [&](const Point& x, double cost) {
            stopped = report && !(best && best->log_cost < cost ? report(best->x, best->log_cost) : report(x, cost));
            return !stopped;
        };
        const SqpResult result = minimise(sweep, problem, start.x, {}, watch);
        const Found found{result.x, std::isfinite(result.log_cost) ? result.log_cost : start.log_cost, stopped};
        if (!best || found.log_cost < best->log_cost) best = found;
        if (stopped) {
            best->stopped = true;
            break;
        }
    }
    return best;
}

}  // namespace tunewright::robust
