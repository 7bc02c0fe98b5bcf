#include "engine/tuning/robust/plane_search.h"

#include <cmath>

#include "engine/numerics/extremum.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kPlaneTolerance = 1e-4;  // of the simulations
constexpr double kCorner = 0.4;           // of the simplex, to the first (the paper's section 4.2)
constexpr int kGridPoints = 25;
constexpr double kGridReach = 3.0;  // ln: a factor of 20 to either side

/// Newton in ln(Kp) alone, from the grid's tangency to the refined peak's.
void tighten(const Sweep& sweep, DesignPoint& x, bool upper_end) {
    for (int k = 0; k < 4; ++k) {
        const auto peaks = sweep.peaks(x, -0.05);
        if (peaks.empty()) return;
        const ActivePeak* limit = nullptr;
        for (const auto& peak : peaks)
            if ((peak.gradient[0] > 0) == upper_end) {
                limit = &peak;
                break;
            }
        if (limit == nullptr || std::abs(limit->gradient[0]) < 1e-3) return;
        const double step = -(limit->value + 1e-8) / limit->gradient[0];
        if (std::abs(step) < 1e-10 || std::abs(step) > 0.1) return;
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
        DesignPoint x = {std::log(gains[i]), std::log(Ti), problem.pid ? std::log(Td) : 0};
        tighten(sweep, x, i % 2 == 0);  // the ends of a gap follow each other, the upper one first
        if (best && log_cost_bound(problem, x) >= best->log_cost) continue;
        const auto peaks = sweep.peaks(x, -0.05);
        if (!peaks.empty() && peaks[0].value > 1e-5) continue;  // between grid points the gap is closed after all
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
    double centre_Ti = std::log(Ti), centre_Td = std::log(std::max(Td, 1e-300)), reach = kGridReach;
    const int Td_points = problem.pid ? kGridPoints : 1;
    for (int round = 0; round < 4; ++round, reach /= 6) {
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
