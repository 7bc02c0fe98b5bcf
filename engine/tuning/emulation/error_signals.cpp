#include "engine/tuning/emulation/error_signals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace tunewright::emulation {
namespace {

constexpr double kSeriesUpTo = 3;  // of h/Tf, where the recursion starts to be the accurate one
constexpr int kSeriesTerms = 40;

using Four = std::array<double, 4>;

// Coefficients in powers of sigma of the cubic with value 1 at position `at` and 0 at the other three of -first, 1 -
// first, ...
Four lagrange(int at, int first) {
    Four c{1, 0, 0, 0};
    int degree = 0;
    double scale = 1;
    for (int j = 0; j < 4; ++j) {
        if (j == at) continue;
        const double root = j - first;
        for (int k = ++degree; k > 0; --k) {
            const auto i = static_cast<std::size_t>(k);
            c[i] = c[i - 1] - root * c[i];
        }
        c[0] *= -root;
        scale *= at - j;
    }
    for (double& value : c) value /= scale;
    return c;
}

// Weights of four neighbours in an integral over one interval, from the integrals of sigma^k over it; `first` of them
// lie before the interval's start.
Four interval_weights(const Four& moments, int first) {
    Four weights{};
    for (int at = 0; at < 4; ++at) {
        const Four c = lagrange(at, first);
        for (std::size_t k = 0; k < 4; ++k) weights[static_cast<std::size_t>(at)] += c[k] * moments[k];
    }
    return weights;
}

// a int_0^1 e^(-a (1 - sigma)) sigma^k d sigma for k = 0 to 3.
Four filter_moments(double a) {
    Four moments{};
    if (a > kSeriesUpTo) {
        moments[0] = -std::expm1(-a);
        for (std::size_t k = 1; k < 4; ++k) moments[k] = 1 - static_cast<double>(k) / a * moments[k - 1];
        return moments;
    }
    for (int k = 0; k < 4; ++k) {
        double term = 1.0 / (k + 1), sum = term;
        for (int j = 1; j < kSeriesTerms; ++j) sum += term *= -a / (j + k + 1);
        moments[static_cast<std::size_t>(k)] = a * sum;
    }
    return moments;
}

// Calls `step(i, integral)` with the weighted integral over each interval i.
void over_intervals(const std::vector<double>& samples, const Four& moments,
                    const std::function<void(std::size_t, double)>& step) {
    const std::array<Four, 3> weights = {interval_weights(moments, 0), interval_weights(moments, 1),
                                         interval_weights(moments, 2)};
    const std::size_t last = samples.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const std::size_t before = i == 0 ? 0 : i + 1 == last ? 2 : 1;
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += weights[before][k] * samples[i - before + k];
        step(i, sum);
    }
}

}  // namespace

std::vector<double> running_integral(const std::vector<double>& samples, double h) {
    std::vector<double> integral(samples.size(), 0);
    over_intervals(samples, {1, 1.0 / 2, 1.0 / 3, 1.0 / 4},
                   [&](std::size_t i, double part) { integral[i + 1] = integral[i] + h * part; });
    return integral;
}

std::vector<double> filtered_derivative(const std::vector<double>& e, double h, double Tf, double x0) {
    std::vector<double> derivative(e.size());
    const double a = h / Tf, decay = std::exp(-a);
    double x = x0;
    derivative[0] = (e[0] - x) / Tf;
    over_intervals(e, filter_moments(a), [&](std::size_t i, double part) {
        x = decay * x + part;
        derivative[i + 1] = (e[i + 1] - x) / Tf;
    });
    return derivative;
}

}  // namespace tunewright::emulation
