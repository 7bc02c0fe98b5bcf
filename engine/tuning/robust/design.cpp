#include "engine/tuning/robust/design.h"

#include <algorithm>
#include <complex>
#include <limits>
#include <numbers>

#include "engine/numerics/fast_complex.h"

namespace tunewright::robust {
namespace {

using Complex = std::complex<double>;

constexpr double kBeyondCorners = 100;  // multiple of the outer corners: the phase is followed up to there
constexpr int kLagPointsPerDecade = 60;

constexpr double kMaxResonantDamping = 0.05;  // damping below which a resonance may require a loop much slower than it
constexpr double kStepDown = 1.1, kMinFrequencyRatio = 1e-8;  // ratio of successive frequencies below the resonance,
                                                              // and the last one
constexpr double kFarReferenceRatio =
    0.1;  // multiple of the usual reference: higher frequencies are within its grid and its scans
constexpr double kNearReferenceRatio = 0.5;    // the same for a loop that must be found more precisely
constexpr double kSparePhase[] = {0.1, 0.01};  // rad, lead of a PID above that which Ms and Mt need with two
                                               // integrators

}  // namespace

double reference_frequency(const DesignProblem& problem) {
    if (problem.reference) return *problem.reference;
    if (problem.measured) return problem.measured->phase_crossover().value_or(problem.measured->high() / 3);
    const LinearPlant& plant = *problem.plant;
    const double L = plant.dead_time();
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    const auto note = [&](double corner) {
        if (!(corner > 0)) return;
        slowest = std::min(slowest, corner);
        fastest = std::max(fastest, corner);
    };
    for (const auto pole : plant.poles()) note(std::abs(pole));
    for (const auto zero : plant.zeros()) note(std::abs(zero));
    if (L > 0) note(1 / L);
    const double Tf = problem.filter.Tf.value_or(0);
    if (Tf > 0) note(1 / Tf);
    if (fastest == 0) return 1;
    // Right-half-plane poles are mirrored: the frequency at which the lag of the loop's other parts reaches half a
    // turn.
    const auto lagging = [&](double w) {
        const Complex s(0, w);
        Complex value = quotient(1, 1.0 + product(Tf * s, 1.0 + 0.5 * Tf * s));
        for (const auto zero : plant.zeros()) value = product(value, quotient(s - zero, -zero));
        for (const auto pole : plant.poles()) value = quotient(value, s - Complex(-std::abs(pole.real()), pole.imag()));
        return value;
    };
    double w = slowest / kBeyondCorners, before = std::arg(lagging(w)),
           unwrapped = -0.5 * std::numbers::pi * plant.integrators();
    double total_before = unwrapped - w * L, fallen = 0;
    constexpr double kFallenPhase = -0.75 * std::numbers::pi;
    const double ratio = std::pow(10, 1.0 / kLagPointsPerDecade);
    for (; w < fastest * kBeyondCorners; w *= ratio) {
        const double wrapped = std::arg(lagging(w));
        unwrapped += std::remainder(wrapped - before, 2 * std::numbers::pi);
        before = wrapped;
        const double total = unwrapped - w * L;
        if (total_before > -std::numbers::pi && total <= -std::numbers::pi) return w;
        if (total_before > kFallenPhase && total <= kFallenPhase) fallen = w;
        total_before = total;
    }
    if (L > 0) return 1 / L;
    if (fallen > 0) return fallen;
    return Tf > 0 ? 1 / Tf : slowest;
}

namespace {

/// The crossover of a gain that keeps the peak of a lightly damped resonance within Ms, if it is much lower.
std::optional<double> crossover_below_resonance(const DesignProblem& problem, double usual) {
    const LinearPlant& plant = *problem.plant;
    const auto size = [&](double omega) { return magnitude(plant.at({0, omega})); };
    double slowest = kFarReferenceRatio * usual;
    for (const auto pole : plant.poles()) {
        const double top = std::abs(pole);
        if (pole.imag() <= 0 || std::abs(pole.real()) > kMaxResonantDamping * top) continue;
        const double crossing = size(top) / (1 - 1 / problem.limits.Ms);
        double omega = top;
        while (omega > kMinFrequencyRatio * top && size(omega) < crossing) omega /= kStepDown;
        slowest = std::min(slowest, omega);
    }
    return slowest < kFarReferenceRatio * usual ? std::optional(slowest) : std::nullopt;
}

/// The frequency at which the lags other than the integrators reach that phase, in rad.
double frequency_of_lag(const LinearPlant& plant, double phase) {
    double delay = plant.dead_time();
    for (const auto pole : plant.poles())
        if (pole != 0.0) delay += std::abs(pole.real()) / std::norm(pole);
    for (const auto zero : plant.zeros()) delay += zero.real() / std::norm(zero);
    return phase / delay;
}

}  // namespace

std::vector<double> slower_references(const DesignProblem& problem) {
    if (problem.plant == nullptr || problem.plant->integrators() <= 0) return {};
    const double usual = reference_frequency(problem);
    std::vector<double> slower;
    if (const auto crossover = crossover_below_resonance(problem, usual))
        slower = {*crossover, std::sqrt(*crossover * usual)};
    if (problem.plant->integrators() > 1)
        for (const double phase : kSparePhase)
            if (const double omega = frequency_of_lag(*problem.plant, phase);
                omega > 0 && omega < kNearReferenceRatio * usual)
                slower.push_back(omega);
    return slower;
}

}  // namespace tunewright::robust
