// The controlled plant in the user's description. Values are deviations from the operating point, except those of a
// nonlinear plant; time is in the user's unit, omega in rad per that unit. `Plant` is a linear SISO plant y = P(s) (u +
// d) with dead time L >= 0 at its input; `PlantModel` is any plant that a request may have.
#pragma once

#include <complex>
#include <optional>
#include <variant>
#include <vector>

#include "engine/plant/frequency_response.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright {

/// Factors of a nominal value that enclose the true one: 0 < low <= 1 <= high.
struct FactorRange {
    double low = 1;
    double high = 1;
};

/// Uncertainty of a plant's parameters around their nominal values. K is the whole plant's gain, for every type.
struct Uncertainty {
    std::optional<FactorRange> K = {}, T = {}, T1 = {}, T2 = {}, L = {};
    bool empty() const { return !K && !T && !T1 && !T2 && !L; }
};

/// K e^(-Ls) / (T s + 1), for any T: T < 0 is unstable, T = 0 a pure dead time with gain.
struct Fopdt {
    double K = 0;
    double T = 0;
    double L = 0;
    Uncertainty uncertainty = {};
};

/// K e^(-Ls) / ((T1 s + 1)(T2 s + 1)).
struct Sopdt {
    double K = 0;
    double T1 = 0;
    double T2 = 0;
    double L = 0;
    Uncertainty uncertainty = {};
};

/// K e^(-Ls) / (T^2 s^2 + 2 zeta T s + 1).
struct OscillatorySopdt {
    double K = 0;
    double T = 0;
    double zeta = 0;
    double L = 0;
    Uncertainty uncertainty = {};
};

/// K e^(-Ls) / (s (T s + 1)); K is the slope of y per unit of u.
struct Ipdt {
    double K = 0;
    double L = 0;
    double T = 0;
    Uncertainty uncertainty = {};
};

/// num(s)/den(s) e^(-Ls), coefficients in descending powers of s, proper.
struct TransferFunction {
    std::vector<double> num;
    std::vector<double> den;
    double L = 0;
    Uncertainty uncertainty = {};
};

/// K prod(s - z)/prod(s - p) e^(-Ls). K is not the static gain.
struct Zpk {
    double K = 0;
    std::vector<std::complex<double>> zeros;  ///< complex ones in conjugate pairs
    std::vector<std::complex<double>> poles;
    double L = 0;
    Uncertainty uncertainty = {};
};

/// x' = A x + B u(t - L), y = C x + D u(t - L). A is n x n (rows), B and C have n entries.
struct StateSpace {
    std::vector<std::vector<double>> A;
    std::vector<double> B;
    std::vector<double> C;
    double D = 0;
    double L = 0;
    Uncertainty uncertainty = {};
};

using Plant = std::variant<Fopdt, Sopdt, OscillatorySopdt, Ipdt, TransferFunction, Zpk, StateSpace>;

/// The dead time of any plant.
double dead_time(const Plant& plant);

/// Several plants that one controller must serve. The first is nominal; at least one.
struct PlantSet {
    std::vector<Plant> plants;
};

/// Any plant of a request: one linear plant (perhaps with uncertain parameters), several, measured points of one, or
/// differential equations.
using PlantModel = std::variant<Plant, PlantSet, FrequencyResponse, NonlinearPlant>;

}  // namespace tunewright
