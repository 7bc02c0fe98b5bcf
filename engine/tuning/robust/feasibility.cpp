#include "engine/tuning/robust/feasibility.h"

#include <algorithm>
#include <cmath>

#include "engine/loop/measured_loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/numerics/extremum.h"
#include "engine/tuning/robust/scan.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {
namespace {

constexpr double kFarTi = 200, kFarTd = 1e-3;  // times the period over 2 pi at the reference frequency
constexpr double kUnstable = 20;               // ln of the larger peak, where the loop is unstable

double larger_measured_peak(const MeasuredPlant& plant, const ParallelPid& gains) {
    const auto loop = MeasuredLoop::make(plant, gains);
    if (!loop || loop->band_too_short() || !loop->count_unstable_poles().stable()) return kUnstable;
    const Peaks peaks = loop->peaks();
    return std::log(std::max(peaks.S.value, peaks.T.value));
}

/// ln of the larger of Ms and Mt, on the grid that the loop itself chooses: far from any limit a search's fixed grid
/// may be left behind.
double larger_peak(const DesignProblem& problem, const DesignPoint& x) {
    const ParallelPid gains = to_parallel(controller_at(problem, x));
    if (problem.measured) return larger_measured_peak(*problem.measured, gains);
    double largest = 0;
    for (std::size_t i = 0; i < problem.plants(); ++i) {
        const auto loop = Loop::make(problem.plant_at(i), gains);
        if (!loop || !count_unstable_poles(*loop).stable()) return kUnstable;
        const Peaks peaks = find_peaks(*loop, make_loop_grid(*loop));
        largest = std::max({largest, peaks.S.value, peaks.T.value});
    }
    return std::log(largest);
}

/// A feasible point under ever wider limits.
std::optional<DesignPoint> stabilising_point(DesignProblem problem, double reference) {
    for (double excess = 0.5; excess < 40; excess *= 1.6) {
        problem.limits = Limits{.Ms = 1 + excess, .Mt = 1 + excess, .Mks = std::nullopt, .m_circle = false};
        const Sweep sweep(problem, reference);
        auto points = scan(sweep, {.Ti_points = 13, .Td_points = 11});
        if (!points.empty()) return points.front().x;
    }
    return std::nullopt;
}

}  // namespace

std::optional<LeastPeak> least_common_peak(const DesignProblem& problem) {
    const double reference = reference_frequency(problem);
    const auto start = stabilising_point(problem, reference);
    if (!start) return std::nullopt;
    const auto n = static_cast<std::size_t>(problem.dimension());
    // The least peak itself often lies at Ti = infinity, where nothing returns to the set point: kept within what a
    // design would use.
    const double longest = std::log(kFarTi / reference), shortest = std::log(kFarTd / reference);
    DesignPoint centre = *start;
    // The unknowns are steps from the centre: a logarithm's own size depends on the unit of time.
    const auto stepped = [&](const std::vector<double>& step) {
        DesignPoint x = centre;
        for (std::size_t i = 0; i < n; ++i) x[i] += step[i];
        return x;
    };
    const auto cost = [&](const std::vector<double>& step, bool&) {
        const DesignPoint x = stepped(step);
        const double beyond = std::max(0.0, x[1] - longest) + (n > 2 ? std::max(0.0, shortest - x[2]) : 0);
        return larger_peak(problem, x) + 0.1 * beyond;
    };
    double least = kUnstable;
    // Started anew with shorter steps: the larger of two peaks has kinks on which a search stalls.
    for (const double step : {0.4, 0.1, 0.1}) {
        const auto found = find_local_minimum(LocalSearch::subplex, cost, std::vector<double>(n, 0.0),
                                              {.step = std::vector<double>(n, step), .tolerance = 1e-5});
        centre = stepped(found.x);
        least = found.value;
    }
    if (least >= kUnstable) return std::nullopt;
    return LeastPeak{std::exp(least), centre};
}

std::optional<DesignPoint> feasible_near(const Sweep& sweep, const DesignPoint& x) {
    auto moved = restore(sweep, x);
    return moved && is_stable(sweep.problem(), *moved) ? moved : std::nullopt;
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
    // Far above every corner the plant is K/s^2: feasible there means feasible at every higher speed.
    const auto asymptote = LinearPlant::make(Zpk{.K = problem.sign, .zeros = {}, .poles = {0.0, 0.0}, .L = 0});
    DesignProblem limit = problem;
    limit.plant = &*asymptote;
    limit.others = {};
    limit.sign = 1;
    return !scan(Sweep(limit, 1), {.Ti_points = 13, .Td_points = 11}).empty();
}

}  // namespace tunewright::robust
