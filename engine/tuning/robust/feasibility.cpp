#include "engine/tuning/robust/feasibility.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/tuning/robust/scan.h"

namespace tunewright::robust {
namespace {

constexpr double kUnstable = 20;  // ln of the larger peak, where the loop is unstable

/// ln of the larger of Ms and Mt, on the grid that the loop itself chooses: far from any limit a search's fixed grid
/// may be left behind.
double larger_peak(unsigned n, const double* x, double*, void* data) {
    const auto& problem = *static_cast<const Problem*>(data);
    const auto loop = Loop::make(*problem.plant, to_parallel(controller_at(problem, {x[0], x[1], n > 2 ? x[2] : 0})));
    if (!loop || !count_unstable_poles(*loop).stable()) return kUnstable;
    const Peaks peaks = find_peaks(*loop, make_loop_grid(*loop));
    return std::log(std::max(peaks.S.value, peaks.T.value));
}

/// A feasible point under ever wider limits.
std::optional<Point> stabilising_point(Problem problem, double reference) {
    for (double excess = 0.5; excess < 40; excess *= 1.6) {
        problem.limits = Limits{.Ms = 1 + excess, .Mt = 1 + excess, .Mks = std::nullopt, .m_circle = false};
        const Sweep sweep(problem, reference);
        auto points = scan(sweep, 13, 11);
        if (!points.empty()) return points.front().x;
    }
    return std::nullopt;
}

}  // namespace

std::optional<double> smallest_common_peak(const Problem& problem) {
    const double reference = reference_frequency(problem);
    const auto start = stabilising_point(problem, reference);
    if (!start) return std::nullopt;
    const auto n = static_cast<unsigned>(problem.dimension());
    double best = kUnstable;
    Point x = *start;
    for (int restart = 0; restart < 3; ++restart) {
        const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(nlopt_create(NLOPT_LN_SBPLX, n),
                                                                               nlopt_destroy);
        nlopt_set_min_objective(optimiser.get(), larger_peak, const_cast<Problem*>(&problem));
        nlopt_set_ftol_abs(optimiser.get(), 1e-5);
        nlopt_set_maxeval(optimiser.get(), 400);
        nlopt_set_initial_step1(optimiser.get(), restart == 0 ? 0.4 : 0.1);
        double value = 0;
        if (nlopt_optimize(optimiser.get(), x.data(), &value) > 0) best = std::min(best, value);
    }
    if (best >= kUnstable) return std::nullopt;
    return std::exp(best);
}

bool has_no_finite_optimum(const Problem& problem) {
    const LinearPlant& plant = *problem.plant;
    if (plant.dead_time() > 0 || plant.has_right_half_plane_zero() || problem.limits.Mks) return false;
    if (problem.filter.Tf && *problem.filter.Tf > 0) return false;
    const int excess = plant.pole_excess();
    if (excess == 0) return true;
    const bool tied = problem.pid && problem.filter.Tf_over_Td.has_value();
    if (excess > (problem.pid ? 2 : 1)) return false;
    if (excess <= 1 || !tied) return true;
    // Far above every corner the plant is K/s^2: feasible there means feasible at every higher speed.
    const auto asymptote = LinearPlant::make(Zpk{.K = problem.sign, .zeros = {}, .poles = {0.0, 0.0}, .L = 0});
    Problem limit = problem;
    limit.plant = &*asymptote;
    limit.sign = 1;
    return !scan(Sweep(limit, 1), 13, 11).empty();
}

}  // namespace tunewright::robust
