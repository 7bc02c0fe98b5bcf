// Peaks and stability of a loop, independent of the engine: a dense sweep over frequency and a count of turns.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <optional>

#include "engine/controller/pid.h"

namespace tunewright::range_tests {

using Complex = std::complex<double>;

struct DensePeaks {
    double Ms = 0, Mt = 0;
    bool stable = false;
};

/// P(s) of a rational plant with dead time, from the test itself.
using PlantFunction = std::function<Complex(Complex s)>;

inline Complex pid_at(const IdealPid& pid, Complex s) {
    const double Tf = pid.filter.type == FilterType::none ? 0 : pid.filter.Tf;
    return pid.Kp * (1.0 + 1.0 / (s * pid.Ti) + s * pid.Td) / (1.0 + s * Tf + 0.5 * s * s * Tf * Tf);
}

/// Peaks over [low, high] on `points` logarithmic points. Stability of a plant with `unstable_poles`, no pole on the
/// axis but `integrators` at 0, strictly proper: the turn of 1 + L from just above 0 to infinity, Nyquist's criterion:
/// the origin's detour turns it by -90 degrees for each integrator, the controller's included, so arg(1 + L) must
/// change by (unstable poles + (integrators + 1)/2) 180 degrees.
inline DensePeaks dense_peaks(const PlantFunction& plant, const IdealPid& pid, double low, double high, int points,
                              int unstable_poles = 0, int integrators = 0) {
    DensePeaks result;
    double turned = 0, before = 0;
    for (int i = 0; i < points; ++i) {
        const Complex s(0, low * std::pow(high / low, double(i) / (points - 1)));
        const Complex L = plant(s) * pid_at(pid, s), distance = 1.0 + L;
        result.Ms = std::max(result.Ms, 1 / std::abs(distance));
        result.Mt = std::max(result.Mt, std::abs(L / distance));
        const double angle = std::arg(distance);
        if (i > 0) turned += std::remainder(angle - before, 2 * std::numbers::pi);
        before = angle;
    }
    const double wanted = std::numbers::pi * (unstable_poles + 0.5 * (integrators + 1));
    result.stable = std::abs(turned - wanted) < 0.3;
    return result;
}

}  // namespace tunewright::range_tests
