// Random plants for the comparison of searches: each depends only on its index, and is the same on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <string>

#include "engine/plant/plant.h"

namespace tunewright::test {

/// SplitMix64 (Steele, Lea and Flood 2014): the standard library's distributions differ between implementations.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform(double low, double high) { return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53; }
    double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
    bool one_in(double n) { return uniform(0, n) < 1; }
    int whole(int low, int high) { return static_cast<int>(std::floor(uniform(low, high + 1))); }

private:
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

struct RandomPlant {
    std::string description;
    bool resonant = false;
    Zpk plant;
    double M = 1.4;  ///< limit of Ms and Mt
};

inline void add_pair(std::vector<std::complex<double>>& roots, double frequency, double zeta) {
    const std::complex<double> root = frequency * std::complex<double>(-zeta, std::sqrt(1 - zeta * zeta));
    roots.push_back(root);
    roots.push_back(std::conj(root));
}

/// `resonant`: one or two pairs of poles with zeta 0.02 to 0.3 among none to three real lags. Else one to five poles,
/// real or well damped, seldom an integrator or an unstable pole. Dead time none to several lags; zeros on either side
/// of the axis, and resonant ones. The last lag makes the plant strictly proper.
inline RandomPlant random_plant(std::uint64_t seed, bool resonant) {
    Random random(seed * 2654435761u + (resonant ? 1 : 0));
    RandomPlant result;
    result.resonant = resonant;
    Zpk& plant = result.plant;
    double slowest = 0;
    const auto add_lag = [&](double T) {
        plant.poles.emplace_back(-1 / T);
        slowest = std::max(slowest, T);
    };
    const int lags = resonant ? random.whole(0, 3) : random.whole(1, 5);
    for (int i = 0; i < lags; ++i) add_lag(random.log_uniform(0.05, 10));
    const int pairs = resonant ? random.whole(1, 2) : (random.one_in(4) ? 1 : 0);
    for (int i = 0; i < pairs; ++i) {
        const double w = random.log_uniform(0.2, 10);
        add_pair(plant.poles, w, resonant ? random.log_uniform(0.02, 0.3) : random.uniform(0.4, 0.95));
        slowest = std::max(slowest, 1 / w);
    }
    if (!resonant && random.one_in(7)) plant.poles.emplace_back(0.0);
    if (!resonant && random.one_in(15)) plant.poles.emplace_back(1 / (slowest * random.uniform(3, 10)));
    const int room = static_cast<int>(plant.poles.size()) - 1;
    if (room >= 1 && random.one_in(3))
        plant.zeros.emplace_back((random.one_in(2.5) ? 1 : -1) / random.log_uniform(0.1, 5));
    if (room >= 3 && resonant && random.one_in(4))
        add_pair(plant.zeros, random.log_uniform(0.2, 10), random.log_uniform(0.02, 0.5));
    if (!random.one_in(6)) plant.L = slowest * random.log_uniform(0.01, 4);
    // Scaled to a gain of random sign and size at s = 0 (without integrators).
    std::complex<double> scale = random.log_uniform(0.1, 10) * (random.one_in(4) ? -1 : 1);
    for (const auto pole : plant.poles)
        if (pole != 0.0) scale *= -pole;
    for (const auto zero : plant.zeros) scale /= -zero;
    plant.K = scale.real();
    result.M = random.uniform(1.2, 2);
    result.description = std::string(resonant ? "resonant" : "ordinary") + " plant " + std::to_string(seed);
    return result;
}

}  // namespace tunewright::test
