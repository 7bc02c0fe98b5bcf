#include "engine/identification/relay_test/relay_fourier.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// A frequency response without the sign of the plant: G = sign * A e^(-j lag) with lag in [0, 2 pi).
struct Polar {
    double A, lag, sign;
};

Polar polar(const RecordedCycle& cycle) {
    const double sign = cycle.reversed ? -1 : 1;
    const Complex G = sign * cycle.harmonics.front().G;
    double lag = -std::arg(G);
    if (lag < 0) lag += 2 * kPi;
    return {std::abs(G), lag, sign};
}

/// Unit-gain magnitude and lag of the structure without its dead time at s = sigma + j omega.
Complex denominator(Structure structure, double T, Complex s) {
    switch (structure) {
        case Structure::unstable: return 1.0 - T * s;
        case Structure::ipdt_lag: return s * (1.0 + T * s);
        default: return 1.0 + T * s;
    }
}

ModelShape shape_of(Structure structure, double T, double L) { return {structure, {L, std::log(T), 0, 0}}; }

/// The gain and dead time that satisfy Eqs. 11 and 12 for this T.
struct Matched {
    double K, L;
};

Matched matched(const Polar& point, double omega, Structure structure, double T) {
    const Complex d = denominator(structure, T, Complex(0, omega));
    // 1/(1 - j T omega) has a phase lead: with a negative gain, the lag is half a turn plus that lead.
    const double sign = structure == Structure::unstable ? -point.sign : point.sign;
    const double own = structure == Structure::unstable ? kPi - std::atan(T * omega) : std::arg(d);
    return {sign * point.A * std::abs(d), (point.lag - own) / omega};
}

RelayModel model_at(const RecordedCycle& cycle, const Polar& point, Structure structure, double T) {
    const Matched m = matched(point, cycle.omega(), structure, T);
    RelayModel model{shape_of(structure, T, m.L), m.K, 0, false};
    model.fit_rms = harmonic_misfit(cycle, model.shape, model.K);
    return model;
}

/// ln(|model|/|measured|) at the shifted point: Eq. 13 in logarithms.
double excess(const Polar& point, double omega, Structure structure, double T, double sigma, double magnitude) {
    const Matched m = matched(point, omega, structure, T);
    const Complex s(sigma, omega);
    return std::log(std::abs(m.K) / (std::abs(denominator(structure, T, s)) * magnitude)) - sigma * m.L;
}

}  // namespace

double harmonic_misfit(const RecordedCycle& cycle, const ModelShape& shape, double K) {
    double sum = 0;
    for (const Harmonic& h : cycle.harmonics) {
        const Complex s(0, h.order * cycle.omega());
        sum += std::norm(h.Y - K * unit_transfer(shape, s) * h.U);
    }
    return std::sqrt(2 * sum);
}

std::optional<RelayModel> biased_fopdt(const RecordedCycle& cycle) {
    const Polar point = polar(cycle);
    const double K = cycle.static_gain(), omega = cycle.omega();
    if (!(std::abs(K) > point.A) || !std::isfinite(K)) return std::nullopt;
    const double T = std::sqrt(K * K / (point.A * point.A) - 1) / omega;
    const Structure structure = K * point.sign > 0 ? Structure::fopdt : Structure::unstable;
    const Matched m = matched(point, omega, structure, T);
    if (m.L < 0) return std::nullopt;
    RelayModel model{shape_of(structure, T, m.L), K, 0, true};
    model.fit_rms = harmonic_misfit(cycle, model.shape, K);
    return model;
}

std::vector<RelayModel> unbiased_models(const RecordedCycle& cycle, Complex shifted, double sigma,
                                        Structure structure) {
    const Polar point = polar(cycle);
    const double omega = cycle.omega(), magnitude = std::abs(shifted);
    auto f = [&](double log_T) { return excess(point, omega, structure, std::exp(log_T), sigma, magnitude); };
    constexpr int kIntervals = 400;                     // two roots of one structure are farther apart than an interval
    constexpr double kShortest = 1e-4, kLongest = 1e4;  // of T omega: a shorter lag counts as 0, a longer one as an
                                                        // integrator
    constexpr double kDeadTimeTolerance = 1e-9;         // of the record's length: a dead time that counts as 0
    constexpr double kLogRootTolerance = 1e-14;         // of ln T
    const double low = std::log(kShortest / omega), high = std::log(kLongest / omega);
    std::vector<RelayModel> models;
    double before = f(low);
    for (int i = 1; i <= kIntervals; ++i) {
        const double a = low + (high - low) * (i - 1) / kIntervals, b = low + (high - low) * i / kIntervals;
        const double after = f(b);
        if ((before > 0) != (after > 0)) {
            RelayModel model =
                model_at(cycle, point, structure, std::exp(root_between(f, a, b, before, after, kLogRootTolerance)));
            if (model.shape.L() >= -kDeadTimeTolerance) {
                model.shape.p[0] = std::max(0.0, model.shape.p[0]);
                models.push_back(model);
            }
        }
        before = after;
    }
    std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) { return a.fit_rms < b.fit_rms; });
    return models;
}

std::optional<RelayModel> integrating_model(const RecordedCycle& cycle) {
    const Polar point = polar(cycle);
    const double omega = cycle.omega(), L = (point.lag - 0.5 * kPi) / omega;
    if (L < 0) return std::nullopt;
    RelayModel model{{Structure::ipdt, {L, 0, 0, 0}}, point.sign * point.A * omega, 0, false};
    model.fit_rms = harmonic_misfit(cycle, model.shape, model.K);
    return model;
}

}  // namespace tunewright
