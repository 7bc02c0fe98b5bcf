#include "engine/check/harris.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/fourier.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr int kLeastOrder = 10, kMostOrder = 60;
constexpr double kStandardErrors = 2;
constexpr double kSeen = 2;  // standard errors of a correlation of white noise

/// Coefficients a of e_t = sum a_i e_{t-i} + w_t, and the variance of w (Burg 1967: least squares forwards and backwards,
/// always stable).
struct Autoregression {
    std::vector<double> a;
    double variance = 0;
};

Autoregression burg(const std::vector<double>& e, int order) {
    const std::size_t n = e.size();
    std::vector<double> forward(e), backward(e), before;
    Autoregression model;
    double power = 0;
    for (const double value : e) power += value * value;
    model.variance = power / static_cast<double>(n);
    for (int m = 0; m < order; ++m) {
        double product = 0, squares = 0;
        const auto from = static_cast<std::size_t>(m) + 1;
        for (std::size_t t = from; t < n; ++t) {
            product += forward[t] * backward[t - 1];
            squares += forward[t] * forward[t] + backward[t - 1] * backward[t - 1];
        }
        if (!(squares > 0)) break;
        const double k = 2 * product / squares;
        before = model.a;
        for (std::size_t i = 0; i < before.size(); ++i) model.a[i] = before[i] - k * before[before.size() - 1 - i];
        model.a.push_back(k);
        for (std::size_t t = n - 1; t >= from; --t) {
            const double f = forward[t];
            forward[t] = f - k * backward[t - 1];
            backward[t] = backward[t - 1] - k * f;
        }
        model.variance *= 1 - k * k;
    }
    return model;
}

/// The order with the least criterion of Akaike, corrected for few samples, is not searched: a long model costs little
/// where the samples are many, and what it adds to the impulse response is within its standard error.
int order_for(std::size_t samples, int longest) {
    const int wanted = std::max(kLeastOrder, 3 * longest);
    return std::max(1, std::min({kMostOrder, wanted, static_cast<int>(samples / 10)}));
}

std::vector<double> impulse_response(const std::vector<double>& a, int count) {
    std::vector<double> psi(static_cast<std::size_t>(count), 0.0);
    psi[0] = 1;
    for (std::size_t k = 1; k < psi.size(); ++k)
        for (std::size_t i = 0; i < std::min(k, a.size()); ++i) psi[k] += a[i] * psi[k - 1 - i];
    return psi;
}

/// Relative standard error of a variance of correlated samples, 2/n (1 + 2 sum rho^2) (Bartlett 1946), over the
/// correlations that are seen.
double variance_error(const std::vector<double>& e) {
    const std::size_t n = e.size();
    const auto rho = autocorrelation(e, std::min<std::size_t>(n / 2, 400));
    double sum = 1;
    for (std::size_t k = 1; k < rho.size(); ++k)
        if (std::abs(rho[k]) > kSeen / std::sqrt(static_cast<double>(n))) sum += 2 * rho[k] * rho[k];
    return std::sqrt(2 / static_cast<double>(n) * sum);
}

}  // namespace

HarrisIndex harris_index(std::span<const double> error, std::span<const int> delays) {
    HarrisIndex index;
    const double centre = mean(error);
    std::vector<double> e(error.begin(), error.end());
    double squares = 0;
    for (double& value : e) {
        value -= centre;
        squares += value * value;
    }
    if (e.empty() || !(squares > 0) || delays.empty()) return index;
    const auto model = burg(e, order_for(e.size(), delays.back()));
    const auto psi = impulse_response(model.a, delays.back());
    const double variance = squares / static_cast<double>(e.size());
    double sum = 0;
    int reached = 0;
    for (const int delay : delays) {
        for (; reached < delay; ++reached) sum += psi[static_cast<std::size_t>(reached)] * psi[static_cast<std::size_t>(reached)];
        index.by_delay.push_back(std::min(1.0, model.variance * sum / variance));
    }
    const auto [low, high] = std::ranges::minmax(index.by_delay);
    const double relative = variance_error(e);
    // A ratio near 0 or 1 has a smaller error: both variances then vary together, or one hardly counts.
    const auto width = [&](double eta, double delay) {
        const double of_model = std::sqrt(4 * delay / static_cast<double>(e.size()));
        return kStandardErrors * std::hypot(relative, of_model) * eta * std::max(0.05, 1 - eta);
    };
    index.low = std::max(0.0, low - width(low, delays.front()));
    index.high = std::min(1.0, high + width(high, delays.back()));
    return index;
}

}  // namespace tunewright::check
