// Figures of a sampled loop by brute force: a response in two thousand parts per period, and sums over the samples that
// follow a single pulse in the measurement.
#pragma once

#include <functional>
#include <optional>

#include "tests/engine/loop/sampled_oracle.h"

namespace tunewright::test {

struct BruteResponse {
    double IAE = 0, error_integral = 0, y_max = 0, y_min = 0, TV = 0;
    std::vector<double> u;  // one per sample
};

/// `dead_time` and the law's computation delay in whole parts of Ts/parts. Ends with the period in which y has been
/// near its final value for as long as it took to reach it. `rest`: of y.
struct BruteForce {
    OwnPlant plant;
    double dead_time = 0;
    SampledPid law;
    int parts = 2000;
    int max_samples = 20000;

    BruteResponse respond(double r, double d, double rest) const {
        const OwnPlant::Motion part = plant.over(law.Ts / parts);
        const long lag_load = std::lround(dead_time / law.Ts * parts),
                   lag = lag_load + std::lround(law.computation_delay / law.Ts * parts);
        const double h = law.Ts / parts;
        OwnLaw program(law);
        std::vector<double> x(plant.order(), 0.0);
        BruteResponse out;
        double v = 0, largest = std::abs(rest), u_before = 0;
        int unsettled = 0;
        for (int k = 0; k < max_samples; ++k) {
            out.u.push_back(program.step(r, plant.output(x, v)));
            out.TV += std::abs(out.u.back() - u_before);
            u_before = out.u.back();
            double farthest = 0;
            for (int j = 0; j < parts; ++j) {
                const long g = static_cast<long>(k) * parts + j;
                v = (g >= lag ? out.u[static_cast<std::size_t>((g - lag) / parts)] : 0) + (g >= lag_load ? d : 0);
                const double y0 = plant.output(x, v);
                OwnPlant::move(part, x, v);
                const double y1 = plant.output(x, v), e0 = r - y0, e1 = r - y1;
                const double a = std::abs(e0), b = std::abs(e1);
                out.IAE += 0.5 * h * (e0 * e1 >= 0 ? a + b : (a * a + b * b) / (a + b));
                out.error_integral += 0.5 * h * (e0 + e1);
                out.y_max = std::max({out.y_max, y0, y1});
                out.y_min = std::min({out.y_min, y0, y1});
                farthest = std::max({farthest, std::abs(y1 - rest)});
            }
            largest = std::max(largest, farthest);
            if (farthest > 1e-9 * largest) unsettled = k;
            if (k - unsettled > std::max(20L, 3 * lag / parts)) return out;
        }
        throw std::runtime_error("The brute force has not come to rest.");
    }
};

/// The samples after a pulse n_0 = 1 in the measurement: y + n and u, until both have died out. Empty if they do not.
struct PulseResponse {
    std::vector<double> S, CS;  // samples of S and of C S
};

inline std::optional<PulseResponse> pulse_response_of(OwnLoop loop, int max_samples, int delay_samples) {
    PulseResponse out;
    double largest = 1, largest_u = 0;
    int unsettled = 0;
    for (int k = 0; k < max_samples; ++k) {
        const double n = k == 0 ? 1 : 0;
        out.S.push_back(loop.y() + n);
        out.CS.push_back(-loop.step(n));
        largest = std::max(largest, std::abs(out.S.back()));
        largest_u = std::max(largest_u, std::abs(out.CS.back()));
        if (largest > 30 || !std::isfinite(largest_u)) return std::nullopt;
        if (std::abs(out.S.back()) > 1e-11 * largest || std::abs(out.CS.back()) > 1e-11 * largest_u) unsettled = k;
        if (k - unsettled > 20 + 3 * delay_samples) return out;
    }
    return std::nullopt;
}

inline std::complex<double> sum_at(const std::vector<double>& samples, double angle) {
    const std::complex<double> back = std::polar(1.0, -angle);
    double re = 0, im = 0;  // Horner's scheme from the last sample
    for (std::size_t k = samples.size(); k-- > 0;) {
        const double next = re * back.real() - im * back.imag() + samples[k];
        im = re * back.imag() + im * back.real();
        re = next;
    }
    return {re, im};
}

/// The maximum of f over 0 <= angle <= pi: a grid that is fine both in the angle and in its logarithm, then golden
/// sections around every point that is higher than its neighbours, including the ends.
inline double largest_over_angles(const std::function<double(double)>& f, int linear = 500, int a_decade = 60) {
    std::vector<double> angle{0};
    for (int i = 1; i <= linear; ++i) angle.push_back(std::numbers::pi * i / linear);
    for (int i = 0; i < 4 * a_decade; ++i) angle.push_back(std::numbers::pi * std::pow(10.0, -double(i) / a_decade));
    std::sort(angle.begin(), angle.end());
    angle.erase(std::unique(angle.begin(), angle.end()), angle.end());
    std::vector<double> value;
    for (const double a : angle) value.push_back(f(a));
    double best = *std::max_element(value.begin(), value.end());
    const double threshold = 0.95 * best;
    for (std::size_t i = 0; i < angle.size(); ++i) {
        const double left = i > 0 ? value[i - 1] : -1, right = i + 1 < angle.size() ? value[i + 1] : -1;
        if (value[i] < threshold || value[i] < left || value[i] < right) continue;
        double low = angle[i > 0 ? i - 1 : i], high = angle[i + 1 < angle.size() ? i + 1 : i];
        const double golden = 0.5 * (std::sqrt(5.0) - 1);
        double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
        for (int step = 0; step < 24; ++step) {
            if (fa > fb) {
                high = b, b = a, fb = fa, a = high - golden * (high - low), fa = f(a);
            } else {
                low = a, a = b, fa = fb, b = low + golden * (high - low), fb = f(b);
            }
        }
        best = std::max({best, fa, fb});
    }
    return best;
}

struct BrutePeaks {
    double S = 0, T = 0, CS = 0;
};

inline BrutePeaks peaks_of(const PulseResponse& pulse) {
    return {largest_over_angles([&](double a) { return std::abs(sum_at(pulse.S, a)); }),
            largest_over_angles([&](double a) { return std::abs(1.0 - sum_at(pulse.S, a)); }),
            largest_over_angles([&](double a) { return std::abs(sum_at(pulse.CS, a)); })};
}

}  // namespace tunewright::test
