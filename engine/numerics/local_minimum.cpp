#include "engine/numerics/local_minimum.h"

#include <nlopt.h>

#include <limits>
#include <memory>

namespace tunewright {
namespace {

struct Context {
    const std::function<double(const std::vector<double>&, bool&)>* f;
    nlopt_opt handle;
    LocalMinimum best;
};

double call(unsigned n, const double* x, double*, void* data) {
    auto& context = *static_cast<Context*>(data);
    const std::vector<double> point(x, x + n);
    bool stop = false;
    const double value = (*context.f)(point, stop);
    if (value < context.best.value) context.best = {point, value};
    if (stop) nlopt_force_stop(context.handle);
    return value;
}

}  // namespace

LocalMinimum find_local_minimum(LocalSearch search,
                                const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                std::vector<double> start, const LocalOptions& options) {
    const auto algorithm = search == LocalSearch::nelder_mead ? NLOPT_LN_NELDERMEAD : NLOPT_LN_SBPLX;
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
        nlopt_create(algorithm, static_cast<unsigned>(start.size())), nlopt_destroy);
    Context context{&f, optimiser.get(), {start, std::numeric_limits<double>::infinity()}};
    nlopt_set_min_objective(optimiser.get(), call, &context);
    nlopt_set_initial_step(optimiser.get(), options.step.data());
    nlopt_set_ftol_abs(optimiser.get(), options.tolerance);
    nlopt_set_xtol_rel(optimiser.get(), options.tolerance);
    nlopt_set_maxeval(optimiser.get(), options.most_evaluations);
    double value = 0;
    // Its return code says why it stopped; the best point met counts whatever that was.
    nlopt_optimize(optimiser.get(), start.data(), &value);
    return context.best;
}

}  // namespace tunewright
