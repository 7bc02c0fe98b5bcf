#include "engine/tuning/emulation/step_model.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/extremum.h"

namespace tunewright::emulation {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kMaxEvaluations = 600;
constexpr double kFirstSteps = 0.1;  // in ln T, and of L relative to T

// K by least squares for a shape, and the sum of squares that is left.
struct Fit {
    double K = 0, left = 0;
};

Fit fit(const StepTest& test, double T, double L) {
    double ys = 0, ss = 0, yy = 0;
    for (std::size_t i = 0; i < test.t.size(); ++i) {
        const double s = test.t[i] > L ? -std::expm1(-(test.t[i] - L) / T) : 0;
        ys += s * test.y[i];
        ss += s * s;
        yy += test.y[i] * test.y[i];
    }
    return {ys / ss / test.du, std::max(0.0, yy - ys * ys / ss)};
}

double time_at(const StepTest& test, double share) {
    const double level = share * test.y.back();
    for (std::size_t i = 0; i < test.t.size(); ++i)
        if (std::abs(test.y[i]) >= std::abs(level)) return test.t[i];
    return test.t.back();
}

StepTest held_as_long_again(StepTest test) {
    const std::size_t rows = test.t.size();
    const double end = test.t.back();
    for (std::size_t i = 1; i < rows; ++i) {
        test.t.push_back(end + test.t[i]);
        test.y.push_back(test.y[rows - 1]);
    }
    return test;
}

}  // namespace

Expected<Fopdt> first_order_model(const StepTest& recorded) {
    if (!recorded.settled || recorded.t.size() < 2)
        return Error{ErrorKind::unsupported, "plant",
                     "The simulated step test does not settle, so it has no first-order model: the plant integrates or "
                     "is unstable. Name methods for such plants, simc or lambda, in bounds_from, or give bounds."};
    const StepTest test = held_as_long_again(recorded);
    // The two instants of Smith's construction (28.3 % and 63.2 %) to start from.
    const double slow = time_at(test, 0.632), fast = time_at(test, 0.283);
    const double T0 = std::max(1.5 * (slow - fast), 1e-3 * test.t.back());
    const auto left = [&](const std::vector<double>& x, bool&) {
        const double T = T0 * std::exp(std::clamp(x[0], -7.0, 7.0)), L = T0 * std::max(0.0, x[1]);
        return std::log(fit(test, T, L).left + 1e-300);
    };
    const auto found = find_local_minimum(LocalSearch::nelder_mead, left, {0, std::max(0.0, slow / T0 - 1)},
                                          {{kFirstSteps, kFirstSteps}, kTolerance, kMaxEvaluations});
    const double T = T0 * std::exp(std::clamp(found.x[0], -7.0, 7.0)), L = T0 * std::max(0.0, found.x[1]);
    return Fopdt{.K = fit(test, T, L).K, .T = T, .L = L};
}

}  // namespace tunewright::emulation
