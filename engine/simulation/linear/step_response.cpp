#include "engine/simulation/linear/step_response.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

constexpr int kMaxSamples = 20'000;
constexpr double kSamplesPerUnit = 10;    // samples per time constant or radian of a mode that has not decayed
constexpr double kSamplesPerDouble = 24;  // spacing at most t/24
constexpr double kDecay = 14;             // e^-14 = 8e-7

// [x; 1] moves by exp([A B; 0 0] tau): a constant input is an additional state.
std::vector<double> propagator(const Realisation& realisation, double tau) {
    const int n = realisation.n;
    std::vector<double> augmented(static_cast<size_t>((n + 1) * (n + 1)), 0.0);
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column)
            augmented[row * (n + 1) + column] = realisation.A[row * n + column] * tau;
        augmented[row * (n + 1) + n] = realisation.B[row] * tau;
    }
    return matrix_exponential(augmented, n + 1);
}

std::vector<double> propagated(const std::vector<double>& propagator, const std::vector<double>& x) {
    std::vector<double> augmented = x;
    augmented.push_back(1);
    std::vector<double> next(x.size());
    multiply(propagator, augmented, next);
    return next;
}

std::vector<double> times_A(const Realisation& realisation, const std::vector<double>& x) {
    std::vector<double> product(x.size());
    multiply(realisation.A, x, product);
    return product;
}

StepSample sample(const Realisation& realisation, double t, std::vector<double> x) {
    const auto output = [&](const std::vector<double>& state) { return dot(state, realisation.C); };
    std::vector<double> rate = times_A(realisation, x);
    for (size_t i = 0; i < rate.size(); ++i) rate[i] += realisation.B[i];
    const double curvature = output(times_A(realisation, rate));
    const double y = output(x) + realisation.D;
    return {t, std::move(x), y, output(rate), curvature};
}

double decay_time(std::complex<double> pole, double modes) { return (kDecay + 3 * modes) / -pole.real(); }

// The spacing for the modes that have not decayed at t.
double spacing(const LinearPlant& plant, double t, double shortest) {
    double h = std::max(shortest, t / kSamplesPerDouble);
    for (const auto pole : plant.poles()) {
        const bool alive = pole.real() >= 0 || t < decay_time(pole, 0);
        if (alive) h = std::min(h, 1 / (kSamplesPerUnit * std::abs(pole)));
    }
    return h;
}

}  // namespace

StepSample step_response_after(const Realisation& realisation, const StepSample& from, double tau) {
    return sample(realisation, from.t + tau, propagated(propagator(realisation, tau), from.x));
}

std::vector<StepSample> step_response(const LinearPlant& plant) {
    const Realisation& realisation = plant.realisation();
    std::vector<StepSample> samples{sample(realisation, 0, std::vector<double>(realisation.n, 0.0))};
    double fastest = 0, t_end = 0;
    for (const auto pole : plant.poles()) {
        fastest = std::max(fastest, std::abs(pole));
        if (pole.real() < 0) t_end = std::max(t_end, decay_time(pole, static_cast<double>(plant.poles().size())));
    }
    if (t_end == 0) return samples;

    const double shortest = 1 / (2 * kSamplesPerUnit * fastest);
    std::vector<std::vector<double>> doublings;  // propagators over shortest 2^k
    while (samples.back().t < t_end && static_cast<int>(samples.size()) < kMaxSamples) {
        const double t = samples.back().t;
        const auto k =
            static_cast<size_t>(std::max(0.0, std::floor(std::log2(spacing(plant, t, shortest) / shortest))));
        while (doublings.size() <= k)
            doublings.push_back(propagator(realisation, std::ldexp(shortest, static_cast<int>(doublings.size()))));
        samples.push_back(sample(realisation, t + std::ldexp(shortest, static_cast<int>(k)),
                                 propagated(doublings[k], samples.back().x)));
    }
    return samples;
}

}  // namespace tunewright
