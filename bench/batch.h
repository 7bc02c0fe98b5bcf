// The AMIGO test batch (Hägglund and Åström 2004): 134 plants common in process industry.
#pragma once

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "engine/plant/plant.h"

namespace tunewright::bench {

struct BatchPlant {
    std::string name;
    Plant plant;
};

inline Zpk lags(std::vector<double> T, double gain = 1, double L = 0) {
    Zpk plant{.K = gain, .zeros = {}, .poles = {}, .L = L};
    for (const double t : T) {
        plant.poles.emplace_back(-1 / t);
        plant.K /= t;
    }
    return plant;
}

inline std::vector<BatchPlant> amigo_batch() {
    std::vector<BatchPlant> batch;
    const auto add = [&](const std::string& family, double parameter, Plant plant) {
        batch.push_back({family + " " + std::to_string(parameter), std::move(plant)});
    };
    const std::vector<double> first = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1,   1.3, 1.5, 2,
                                       4,    6,    8,   10,  20,  50,  100, 200, 500, 1000};
    for (const double T : first) add("P1", T, Fopdt{.K = 1, .T = T, .L = 1});
    std::vector<double> second = first;
    second.insert(second.begin(), 0.01);
    second.pop_back();
    for (const double T : second) add("P2", T, Sopdt{.K = 1, .T1 = T, .T2 = T, .L = 1});
    for (const double T : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0}) add("P3", T, lags({1, T, T}));
    for (const int n : {3, 4, 5, 6, 7, 8}) add("P4", n, lags(std::vector<double>(static_cast<std::size_t>(n), 1.0)));
    for (int i = 1; i <= 9; ++i) {
        const double a = 0.1 * i;
        add("P5", a, lags({1, a, a * a, a * a * a}));
    }
    for (const double L : {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0})
        add("P6", L, Ipdt{.K = 1, .L = L, .T = 1 - L});
    for (const double T : {1.0, 2.0, 5.0, 10.0})
        for (const double L : {0.01, 0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0})
            add("P7", T + L, Sopdt{.K = T, .T1 = T, .T2 = 1 - L, .L = L});
    for (int i = 1; i <= 11; ++i) {
        const double a = 0.1 * i;
        add("P8", a, Zpk{.K = -a, .zeros = {1 / a}, .poles = {-1, -1, -1}, .L = 0});
    }
    for (int i = 1; i <= 10; ++i) {
        const double T = 0.1 * i;
        const std::complex<double> pole = std::complex<double>(-0.7, std::sqrt(1 - 0.49)) / T;
        add("P9", T, Zpk{.K = 1 / (T * T), .zeros = {}, .poles = {-1, pole, std::conj(pole)}, .L = 0});
    }
    return batch;
}

}  // namespace tunewright::bench
