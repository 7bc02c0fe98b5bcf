#include "engine/numerics/global_minimum.h"

#include <nlopt.h>

#include <memory>

namespace tunewright {
namespace {

struct Context {
    const std::function<double(const std::vector<double>&, bool&)>* f;
    nlopt_opt handle;
    std::vector<LocalMinimum> met;
};

double call(unsigned n, const double* x, double*, void* data) {
    auto& context = *static_cast<Context*>(data);
    const std::vector<double> point(x, x + n);
    bool stop = false;
    const double value = (*context.f)(point, stop);
    context.met.push_back({point, value});
    if (stop) nlopt_force_stop(context.handle);
    return value;
}

}  // namespace

std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int most_evaluations) {
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
        nlopt_create(NLOPT_GN_DIRECT_L, static_cast<unsigned>(box.low.size())), nlopt_destroy);
    Context context{&f, optimiser.get(), {}};
    nlopt_set_min_objective(optimiser.get(), call, &context);
    nlopt_set_lower_bounds(optimiser.get(), box.low.data());
    nlopt_set_upper_bounds(optimiser.get(), box.high.data());
    nlopt_set_maxeval(optimiser.get(), most_evaluations);
    std::vector<double> x(box.low.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.5 * (box.low[i] + box.high[i]);
    double value = 0;
    // Its return code says why it stopped; the points met count whatever that was.
    nlopt_optimize(optimiser.get(), x.data(), &value);
    return std::move(context.met);
}

}  // namespace tunewright
