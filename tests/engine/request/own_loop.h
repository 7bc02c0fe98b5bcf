// The loop of a test's own plant and a product's own program: its load response, and its sensitivity from the response
// of the samples to a pulse on the measurement.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/engine/request/own_plant.h"
#include "tests/engine/request/own_programs.h"

namespace tunewright::test {

/// The integral of |y| after a unit load step at the plant's input; infinite if it does not settle within `max`
/// samples, or exceeds `enough`.
inline double own_load_iae(OwnLoopPlant& plant, OwnProgram program, int max = 3000000,
                           double enough = std::numeric_limits<double>::infinity()) {
    constexpr double kRest = 2e-5;  // of the total, in the second half of the time
    double earlier = 0;
    int next = 512;
    for (int k = 1; k <= max; ++k) {
        plant.step(program(plant.y()));
        if (!(plant.iae() < enough)) break;
        if (k != next) continue;
        if (earlier > 0 && plant.iae() - earlier < kRest * plant.iae()) return plant.iae();
        earlier = plant.iae();
        next *= 2;
    }
    return std::numeric_limits<double>::infinity();
}

struct OwnPeaks {
    double Ms = 0, Mt = 0;
};

/// max |S| and |T| at 0 < omega <= pi/Ts: S is the z-transform of the program's input after a pulse of 1 that is added
/// to the measurement once. `Ts` in the plant's time.
inline OwnPeaks own_peaks(OwnLoopPlant plant, OwnProgram program, double Ts) {
    std::vector<double> read;
    double largest = 0, recent = 0;
    for (int k = 0; k < 400000; ++k) {
        const double y = plant.y() + (k == 0 ? 1 : 0);
        read.push_back(y);
        plant.step(program(y));
        // Settled if a stretch of a fifth of the whole stays small. The pulse itself is not counted.
        if (k > 0) largest = std::max(largest, std::abs(y));
        recent = std::max(recent, std::abs(y));
        if ((k & (k - 1)) == 0 && k > 256) {
            if (recent < 1e-9 * largest) break;
            recent = 0;
        }
    }
    const auto S = [&](double omega) {
        const std::complex<double> step = std::polar(1.0, -omega * Ts);
        std::complex<double> sum = 0;
        for (auto y = read.rbegin(); y != read.rend(); ++y) sum = sum * step + *y;  // Horner's scheme
        return sum;
    };
    const auto peak = [&](auto&& value) {
        constexpr int kLooks = 400;
        constexpr double kNear = 0.97;  // relative to the highest: other maxima may be higher after refinement
        const double high = std::numbers::pi / Ts, low = high * 1e-7, ratio = std::pow(high / low, 1.0 / kLooks);
        std::vector<double> looked;
        for (int i = 0; i <= kLooks; ++i) looked.push_back(value(low * std::pow(ratio, i)));
        double best = *std::max_element(looked.begin(), looked.end());
        const double enough = kNear * best;
        for (std::size_t i = 1; i < looked.size(); ++i) {
            const bool top = looked[i] >= looked[i - 1] && (i + 1 == looked.size() || looked[i] >= looked[i + 1]);
            if (!top || looked[i] < enough) continue;
            const double at = low * std::pow(ratio, static_cast<double>(i));
            double a = at / ratio, b = std::min(high, at * ratio);
            const double golden = (std::sqrt(5.0) - 1) / 2;
            for (int k = 0; k < 20; ++k) {
                const double x1 = b - golden * (b - a), x2 = a + golden * (b - a);
                const double v1 = value(x1), v2 = value(x2);
                best = std::max({best, v1, v2});
                (v1 > v2 ? b : a) = v1 > v2 ? x2 : x1;
            }
        }
        return best;
    };
    return {peak([&](double omega) { return std::abs(S(omega)); }),
            peak([&](double omega) { return std::abs(1.0 - S(omega)); })};
}

}  // namespace tunewright::test
