#include "engine/numerics/optimise/direct_search.h"

#include <nlopt.h>

#include <limits>
#include <memory>
#include <utility>

namespace tunewright {
namespace {

using Objective = std::function<double(const std::vector<double>&, bool& stop)>;

/// The data that NLopt passes to each evaluation: the function and the collector of points.
template <class Keep>
struct Context {
    const Objective* f;
    nlopt_opt handle;
    Keep keep;
};

template <class Keep>
double call(unsigned n, const double* x, double*, void* data) {
    auto& context = *static_cast<Context<Keep>*>(data);
    std::vector<double> point(x, x + n);
    bool stop = false;
    const double value = (*context.f)(point, stop);
    context.keep(std::move(point), value);
    if (stop) nlopt_force_stop(context.handle);
    return value;
}

using Optimiser = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

Optimiser optimiser_of(nlopt_algorithm algorithm, std::size_t unknowns) {
    return {nlopt_create(algorithm, static_cast<unsigned>(unknowns)), nlopt_destroy};
}

/// Starts from `x`. NLopt's return code only gives the reason for the end: the collected points are valid in every
/// case.
template <class Keep>
void minimise(const Objective& f, const Optimiser& optimiser, std::vector<double> x, Keep keep) {
    Context<Keep> context{&f, optimiser.get(), std::move(keep)};
    nlopt_set_min_objective(optimiser.get(), call<Keep>, &context);
    double value = 0;
    nlopt_optimize(optimiser.get(), x.data(), &value);
}

}  // namespace

LocalMinimum find_local_minimum(LocalSearch search,
                                const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                std::vector<double> start, const LocalOptions& options) {
    const auto algorithm = search == LocalSearch::nelder_mead ? NLOPT_LN_NELDERMEAD : NLOPT_LN_SBPLX;
    const Optimiser optimiser = optimiser_of(algorithm, start.size());
    nlopt_set_initial_step(optimiser.get(), options.step.data());
    nlopt_set_ftol_abs(optimiser.get(), options.tolerance);
    nlopt_set_xtol_rel(optimiser.get(), options.tolerance);
    nlopt_set_maxeval(optimiser.get(), options.max_evaluations);
    LocalMinimum best{start, std::numeric_limits<double>::infinity()};
    minimise(f, optimiser, std::move(start), [&best](std::vector<double>&& point, double value) {
        if (value < best.value) best = {std::move(point), value};
    });
    return best;
}

std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int max_evaluations) {
    const Optimiser optimiser = optimiser_of(NLOPT_GN_DIRECT_L, box.low.size());
    nlopt_set_lower_bounds(optimiser.get(), box.low.data());
    nlopt_set_upper_bounds(optimiser.get(), box.high.data());
    nlopt_set_maxeval(optimiser.get(), max_evaluations);
    std::vector<double> centre(box.low.size());
    for (std::size_t i = 0; i < centre.size(); ++i) centre[i] = 0.5 * (box.low[i] + box.high[i]);
    std::vector<LocalMinimum> met;
    minimise(f, optimiser, std::move(centre), [&met](std::vector<double>&& point, double value) {
        met.push_back({std::move(point), value});
    });
    return met;
}

}  // namespace tunewright
