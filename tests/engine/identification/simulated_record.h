// Records of known plants with known noise, from closed formulas that share no code with the product.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "engine/identification/record/record.h"

namespace tunewright::testing {

using StepCurve = std::function<double(double)>;       ///< of t, 0 for t <= 0
using Steps = std::vector<std::pair<double, double>>;  ///< time and new level of u

/// 1 - e^(-(t-L)/T).
inline StepCurve first_order(double K, double T, double L) {
    return [=](double t) { return t <= L ? 0 : K * -std::expm1(-(t - L) / T); };
}

/// Two different lags.
inline StepCurve two_lags(double K, double T1, double T2, double L) {
    return [=](double t) {
        return t <= L ? 0 : K * (1 - (T1 * std::exp(-(t - L) / T1) - T2 * std::exp(-(t - L) / T2)) / (T1 - T2));
    };
}

/// Damped oscillation, zeta < 1.
inline StepCurve oscillation(double K, double T, double zeta, double L) {
    return [=](double t) {
        if (t <= L) return 0.0;
        const double s = (t - L) / T, w = std::sqrt(1 - zeta * zeta);
        return K * (1 - std::exp(-zeta * s) * (std::cos(w * s) + zeta / w * std::sin(w * s)));
    };
}

inline StepCurve ramp(double K, double L, double T = 0) {
    return [=](double t) {
        if (t <= L) return 0.0;
        const double s = t - L;
        return T > 0 ? K * (s + T * std::expm1(-s / T)) : K * s;
    };
}

inline std::vector<double> even_times(int n, double spacing) {
    std::vector<double> t;
    for (int i = 0; i < n; ++i) t.push_back(i * spacing);
    return t;
}

/// Superposition of the step responses, from rest at (u0, y0).
inline Record simulate(const std::vector<double>& t, double u0, double y0, const Steps& steps,
                       const StepCurve& response) {
    Record record;
    record.t = t;
    for (double time : t) {
        double u = u0, y = y0;
        for (const auto& [when, level] : steps) {
            const double jump = level - u;
            if (time < when) break;
            y += jump * response(time - when);
            u = level;
        }
        record.u.push_back(u);
        record.y.push_back(y);
    }
    return record;
}

/// Gaussian noise by Box and Muller (the standard library's normal distribution differs between libraries),
/// autoregressive with `pole`.
inline void add_noise(Record& record, double std, unsigned seed, double pole = 0) {
    std::mt19937 bits(seed);
    auto uniform = [&] { return (bits() + 0.5) / 4294967296.0; };
    double state = 0;
    for (double& y : record.y) {
        const double white = std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
        state = pole * state + std::sqrt(1 - pole * pole) * white;
        y += std * state;
    }
}

}  // namespace tunewright::testing
