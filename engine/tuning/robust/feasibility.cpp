#include "engine/tuning/robust/feasibility.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/tuning/robust/scan.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {
namespace {

constexpr double kUnstable = 20;  // ln of the larger peak, where the loop is unstable

struct PeakSearch {
    const Sweep* sweep;
    const Problem* problem;
};

double larger_peak(unsigned n, const double* x, double*, void* data) {
    const auto& search = *static_cast<PeakSearch*>(data);
    const Point point = {x[0], x[1], n > 2 ? x[2] : 0};
    if (!is_stable(*search.problem, point)) return kUnstable;
    const auto peaks = search.sweep->peaks(point, -1);
    return peaks.empty() ? 0 : peaks.front().value;
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
    Problem free = problem;
    free.limits =
        Limits{.Ms = 1, .Mt = 1, .Mks = std::nullopt, .m_circle = false};  // then a constraint's value is ln(peak)
    const Sweep sweep(free, reference);
    PeakSearch search{&sweep, &free};
    const auto n = static_cast<unsigned>(problem.dimension());
    double best = kUnstable;
    Point x = *start;
    for (int restart = 0; restart < 3; ++restart) {
        const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(nlopt_create(NLOPT_LN_SBPLX, n),
                                                                               nlopt_destroy);
        nlopt_set_min_objective(optimiser.get(), larger_peak, &search);
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
