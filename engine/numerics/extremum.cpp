#include "engine/numerics/extremum.h"

#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace tunewright {
namespace {

using Objective = std::function<double(const std::vector<double>&, bool& stop)>;

/// What NLopt hands to each evaluation: the function, and who keeps the points.
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

/// From `x` on. NLopt's return code says only why it stopped: what was kept counts in every case.
template <class Keep>
void minimise(const Objective& f, const Optimiser& optimiser, std::vector<double> x, Keep keep) {
    Context<Keep> context{&f, optimiser.get(), std::move(keep)};
    nlopt_set_min_objective(optimiser.get(), call<Keep>, &context);
    double value = 0;
    nlopt_optimize(optimiser.get(), x.data(), &value);
}

constexpr double kGolden = 0.3819660112501051;  // (3 - sqrt 5)/2
constexpr double kTolerance = 1e-8;             // of ln x: within it f is flat to rounding at a maximum
constexpr double kFlat = 1e-14;                 // of f: the search ends at a step that changes f by less
constexpr int kMaxIterations = 60;
constexpr double kMostRise = 4;  // times that of a parabola

}  // namespace

LocalMinimum find_local_minimum(LocalSearch search,
                                const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                std::vector<double> start, const LocalOptions& options) {
    const auto algorithm = search == LocalSearch::nelder_mead ? NLOPT_LN_NELDERMEAD : NLOPT_LN_SBPLX;
    const Optimiser optimiser = optimiser_of(algorithm, start.size());
    nlopt_set_initial_step(optimiser.get(), options.step.data());
    nlopt_set_ftol_abs(optimiser.get(), options.tolerance);
    nlopt_set_xtol_rel(optimiser.get(), options.tolerance);
    nlopt_set_maxeval(optimiser.get(), options.most_evaluations);
    LocalMinimum best{start, std::numeric_limits<double>::infinity()};
    minimise(f, optimiser, std::move(start), [&best](std::vector<double>&& point, double value) {
        if (value < best.value) best = {std::move(point), value};
    });
    return best;
}

std::vector<LocalMinimum> explore(const std::function<double(const std::vector<double>&, bool& stop)>& f,
                                  const Box& box, int most_evaluations) {
    const Optimiser optimiser = optimiser_of(NLOPT_GN_DIRECT_L, box.low.size());
    nlopt_set_lower_bounds(optimiser.get(), box.low.data());
    nlopt_set_upper_bounds(optimiser.get(), box.high.data());
    nlopt_set_maxeval(optimiser.get(), most_evaluations);
    std::vector<double> centre(box.low.size());
    for (std::size_t i = 0; i < centre.size(); ++i) centre[i] = 0.5 * (box.low[i] + box.high[i]);
    std::vector<LocalMinimum> met;
    minimise(f, optimiser, std::move(centre), [&met](std::vector<double>&& point, double value) {
        met.push_back({std::move(point), value});
    });
    return met;
}

bool may_exceed(double level, const Maximum& before, const Maximum& here, const Maximum& after) {
    if (here.value > level) return true;
    const double left = here.x - before.x, right = after.x - here.x;
    const double up = (here.value - before.value) / left, down = (here.value - after.value) / right;
    const double bend = (up + down) / (left + right), slope = up - bend * left;
    const double rise = bend > 0 ? 0.25 * slope * slope / bend : 0;
    return here.value + kMostRise * rise > level;
}

// Boost's brent_find_minima is not used: it starts from an end of the interval. Where dead time puts two maxima between
// two points of a grid it ended on the lower one (|C S| of lambda tuning on 2 e^(-3s)/(10 s + 1): 6e-5 too low).
// Starting from the known inner point keeps to its hill, at 1.2 times the time of find_peaks.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right) {
    double a = std::log(left), b = std::log(right), x = std::log(known.x), w = x, v = x;
    double fx = -known.value, fw = fx, fv = fx, step = 0, before = 0;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
        const double middle = 0.5 * (a + b);
        if (std::abs(x - middle) <= 2 * kTolerance - 0.5 * (b - a)) break;
        double p = 0, q = 0, r = 0;
        if (std::abs(before) > kTolerance) {
            r = (x - w) * (fx - fv);
            q = (x - v) * (fx - fw);
            p = (x - v) * q - (x - w) * r;
            q = 2 * (q - r);
            if (q > 0) p = -p;
            q = std::abs(q);
        }
        if (std::abs(p) < std::abs(0.5 * q * before) && p > q * (a - x) && p < q * (b - x)) {
            before = step;
            step = p / q;
        } else {
            before = (x < middle ? b : a) - x;
            step = kGolden * before;
        }
        const double u = x + (std::abs(step) >= kTolerance ? step : std::copysign(kTolerance, step));
        const double fu = -f(std::exp(u));
        if (fu <= fx) {
            (u < x ? b : a) = x;
            v = w;
            fv = fw;
            w = x;
            fw = fx;
            x = u;
            fx = fu;
            if (std::abs(fw - fx) <= kFlat * std::abs(fx)) break;
        } else {
            (u < x ? a : b) = u;
            if (fu <= fw || w == x) {
                v = w;
                fv = fw;
                w = u;
                fw = fu;
            } else if (fu <= fv || v == x || v == w) {
                v = u;
                fv = fu;
            }
        }
    }
    return {std::exp(x), -fx};
}

}  // namespace tunewright
