// Plants of the tests of structures.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/structure/interaction_gains.h"
#include "engine/structure/program/predictor_program.h"

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

/// Wardle and Wood, as in Luyben (1986).
inline PlantMatrix wardle_wood() {
    return {{first_order(0.126, 60, 6), transfer({-0.101}, {2160, 93, 1}, 12)},
            {first_order(0.094, 38, 8), first_order(-0.12, 35, 8)}};
}

/// Ogunnaike and Ray, as in Luyben (1986).
inline PlantMatrix ogunnaike_ray() {
    return {{first_order(0.66, 6.7, 2.6), first_order(-0.61, 8.64, 3.5), first_order(-0.0049, 9.06, 1)},
            {first_order(1.11, 3.25, 6.5), first_order(-2.36, 5, 3), first_order(-0.01, 7.09, 1.2)},
            {first_order(-34.68, 8.15, 9.2), first_order(46.2, 10.9, 9.4),
             transfer({10.1007, 0.87}, {73.132, 22.69, 1}, 1)}};
}

/// A polymerisation reactor, Chien, Huang and Yang (1999).
inline PlantMatrix polymerisation() {
    return {{first_order(22.89, 4.572, 0.2), first_order(-11.64, 1.807, 0.4)},
            {first_order(4.689, 2.174, 0.2), first_order(5.8, 1.801, 0.4)}};
}

/// The program of a predictor with the usual rules.
inline Expected<code::Program> usual_program(const PredictorController& controller, double Ts,
                                             const code::CodeOptions& u) {
    const auto gains = predictor_pid(controller);
    if (!gains) return gains.error();
    return predictor_program(controller, {.gains = *gains, .Ts = Ts}, u);
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
