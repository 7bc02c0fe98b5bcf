// Random linear plants of every type, and how far two plants are apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// max |P1 - P2|/|P1| over frequencies around the plants' own.
inline double distance(const Plant& a, const Plant& b) {
    const auto p = LinearPlant::make(a), q = LinearPlant::make(b);
    if (!p || !q) return INFINITY;
    double worst = 0;
    for (double omega = 1e-4; omega < 1e3; omega *= 1.7) {
        const std::complex<double> one = p->at(std::complex<double>(0, omega)),
                                   other = q->at(std::complex<double>(0, omega));
        worst = std::max(worst, std::abs(one - other) / std::abs(one));
    }
    return worst;
}

class RandomPlants {
public:
    Plant next() {
        const double K = signed_value(), L = chance(0.3) ? 0 : value();
        switch (std::uniform_int_distribution(0, 7)(random_)) {
            case 0: return Fopdt{.K = K, .T = signed_value(), .L = L};
            case 1: return Sopdt{.K = K, .T1 = signed_value(), .T2 = chance(0.1) ? 0 : value(), .L = L};
            case 2: return OscillatorySopdt{.K = K, .T = value(), .zeta = signed_value(), .L = L};
            case 3: return Ipdt{.K = K, .L = L, .T = chance(0.5) ? 0 : value()};
            case 4: return TransferFunction{.num = list(3), .den = list(5), .L = L};
            case 5: return Zpk{.K = K, .zeros = roots(1), .poles = roots(3), .L = L};
            case 6: return states(K, L);
            default: return Fopdt{.K = K, .T = 0, .L = L};
        }
    }

private:
    bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
    double value() {
        const double x = std::pow(10, std::uniform_real_distribution(-3.0, 3.0)(random_));
        return chance(0.5) ? std::round(x * 1000) / 1000 + 0.001 : x;
    }
    double signed_value() { return chance(0.3) ? -value() : value(); }
    std::vector<double> list(int size) {
        std::vector<double> out;
        for (int i = 0; i < size; ++i) out.push_back(i > 0 && chance(0.2) ? 0 : signed_value());
        return out;
    }
    std::vector<std::complex<double>> roots(int pairs) {
        std::vector<std::complex<double>> out;
        for (int i = 0; i < pairs; ++i) {
            const double re = signed_value(), im = value();
            if (chance(0.5)) {
                out.emplace_back(re);
            } else {
                out.emplace_back(re, im);
                out.emplace_back(re, -im);
            }
        }
        if (out.size() < 2) return out;
        return out;
    }
    StateSpace states(double D, double L) {
        StateSpace plant{.A = {}, .B = {}, .C = {}, .D = chance(0.5) ? 0 : D, .L = L};
        const int n = std::uniform_int_distribution(1, 3)(random_);
        for (int i = 0; i < n; ++i) {
            plant.A.push_back({});
            for (int k = 0; k < n; ++k) plant.A.back().push_back(i == k ? -value() : signed_value());
            plant.B.push_back(signed_value());
            plant.C.push_back(signed_value());
        }
        return plant;
    }
    std::mt19937 random_{1};
};

}  // namespace tunewright
