// Plants of the tests of structures.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/structure/interaction_gains.h"

namespace tunewright::structure {

inline LinearPlant first_order(double K, double T, double L) {
    return *LinearPlant::make(Plant(Fopdt{.K = K, .T = T, .L = L}));
}

inline LinearPlant transfer(std::vector<double> num, std::vector<double> den, double L = 0) {
    return *LinearPlant::make(Plant(TransferFunction{.num = std::move(num), .den = std::move(den), .L = L}));
}

inline IdealPid pi(double Kp, double Ti) { return {.Kp = Kp, .Ti = Ti}; }

/// Wood and Berry (1973), Chemical Engineering Science 28, 1707-1717.
inline PlantMatrix wood_berry() {
    return {{first_order(12.8, 16.7, 1), first_order(-18.9, 21, 3)},
            {first_order(6.6, 10.9, 7), first_order(-19.4, 14.4, 3)}};
}

/// Vinante and Luyben, as in Luyben (1986).
inline PlantMatrix vinante_luyben() {
    return {{first_order(-2.2, 7, 1), first_order(1.3, 7, 0.3)},
            {first_order(-2.8, 9.5, 1.8), first_order(4.3, 9.2, 0.35)}};
}

class RandomNumbers {
public:
    explicit RandomNumbers(unsigned seed) : engine_(seed) {}
    double log_uniform(double low, double high) {
        return std::exp(std::uniform_real_distribution<>(std::log(low), std::log(high))(engine_));
    }

private:
    std::mt19937 engine_;
};

}  // namespace tunewright::structure
