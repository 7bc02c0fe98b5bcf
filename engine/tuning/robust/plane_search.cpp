#include "engine/tuning/robust/plane_search.h"

#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>

#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kPlaneTolerance = 1e-4;  // of the simulations
constexpr double kNoController = 50;      // ln(cost) where no gain is feasible: finite, as the simplex needs it
constexpr int kGridPoints = 25;
constexpr double kGridReach = 3.0;  // ln: a factor of 20 to either side

/// Newton in ln(Kp) alone, from the grid's tangency to the refined peak's.
void tighten(const Sweep& sweep, Point& x, bool upper_end) {
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

struct Search {
    const Sweep* sweep;
    const Problem* problem;
    const Report* report;
    std::optional<Found> best;
    nlopt_opt handle = nullptr;

    double cost(double log_Ti, double log_Td) {
        const auto found = best_gain(*sweep, *problem, std::exp(log_Ti), std::exp(log_Td), kPlaneTolerance);
        if (!found) return kNoController;
        if (!best || found->log_cost < best->log_cost) {
            best = found;
            if (*report && !(*report)(found->x, found->log_cost)) {
                best->stopped = true;
                if (handle != nullptr) nlopt_force_stop(handle);
            }
        }
        return found->log_cost;
    }
    bool stopped() const { return best && best->stopped; }
};

double objective(unsigned n, const double* x, double*, void* data) {
    return static_cast<Search*>(data)->cost(x[0], n > 1 ? x[1] : 0);
}

}  // namespace

std::optional<Found> best_gain(const Sweep& sweep, const Problem& problem, double Ti, double Td, double tolerance) {
    std::optional<Found> best;
    const auto gains = feasible_gains(sweep, Ti, Td);
    for (std::size_t i = 0; i < gains.size(); ++i) {
        Point x = {std::log(gains[i]), std::log(Ti), problem.pid ? std::log(Td) : 0};
        const bool upper_end = i == 0 || gains[i] > gains[i - 1] || i % 2 == 0;
        tighten(sweep, x, upper_end);
        const auto peaks = sweep.peaks(x, -0.05);
        if (!peaks.empty() && peaks[0].value > 1e-5) continue;  // between grid points the gap is closed after all
        const double cost = log_cost(problem, x, tolerance);
        if (std::isfinite(cost) && (!best || cost < best->log_cost)) best = Found{x, cost, false};
    }
    return best;
}

std::optional<Found> nelder_mead_search(const Sweep& sweep, const Problem& problem, double Ti, double Td,
                                        const Report& report) {
    const unsigned n = problem.pid ? 2 : 1;
    Search search{&sweep, &problem, &report, std::nullopt};
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(nlopt_create(NLOPT_LN_NELDERMEAD, n),
                                                                           nlopt_destroy);
    search.handle = optimiser.get();
    nlopt_set_min_objective(optimiser.get(), objective, &search);
    nlopt_set_xtol_rel(optimiser.get(), 1e-7);
    nlopt_set_ftol_abs(optimiser.get(), 1e-7);
    nlopt_set_maxeval(optimiser.get(), 400);
    const double step[2] = {std::log(0.4), std::log(0.4)};
    nlopt_set_initial_step(optimiser.get(), step);
    double x[2] = {std::log(Ti), std::log(std::max(Td, 1e-300))}, value = 0;
    nlopt_optimize(optimiser.get(), x, &value);  // whatever its code says: `best` was feasible when it was seen
    return search.best;
}

std::optional<Found> grid_search(const Sweep& sweep, const Problem& problem, double Ti, double Td, CostSurface* surface,
                                 const Report& report) {
    Search search{&sweep, &problem, &report, std::nullopt};
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
                surface->cost.back().push_back(log_cost < kNoController ? std::optional<double>(std::exp(log_cost))
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
