// Nonlinear plants for several tests.
#pragma once

#include <stdexcept>
#include <string>

#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// The endothermic CSTR of Mhaskar, El-Farra & Christofides (2004), Eq. 4, with the sign that its numbers have.
inline NonlinearPlant cstr(const std::string& output) {
    return {.states = {{"CA", 0.52}, {"T", 398.97}},
            .parameters = {{"V", 100.0},
                           {"F", 100.0},
                           {"ER", 8000.0},
                           {"CA0", 1.0},
                           {"TA0", 400.0},
                           {"DH", 2e5},
                           {"k0", 4.71e8},
                           {"cp", 1.0},
                           {"rho", 1000.0},
                           {"UA", 1e5}},
            .equations = {{"CA", "F/V*(CA0-CA)-k0*exp(-ER/T)*CA"},
                          {"T", "F/V*(TA0-T)-DH/(rho*cp)*k0*exp(-ER/T)*CA+UA/(rho*cp*V)*(Tj-T)"}},
            .input = {.name = "Tj", .nominal = 493.87},
            .output = output};
}

/// Outflow by gravity: h = (q/c)^2.
inline NonlinearPlant spherical_tank(double h, double q) {
    return {.states = {{"h", h}},
            .parameters = {{"R", 0.5}, {"c", 0.4}, {"pi", 3.14159265358979323846}},
            .equations = {{"h", "(q - c*sqrt(h))/(pi*h*(2*R - h))"}},
            .input = {.name = "q", .nominal = q, .min = 0.0, .max = 1.0},
            .output = "h"};
}

/// Substrate inhibition: Bequette, Process Dynamics (1998), module 8; dilution rate D, its three steady states at 0.3.
inline NonlinearPlant bioreactor(double X, double S) {
    return {
        .states = {{"X", X}, {"S", S}},
        .parameters = {{"mumax", 0.53}, {"Km", 0.12}, {"K1", 0.4545}, {"Y", 0.4}, {"Sf", 4.0}},
        .equations = {{"X", "(mumax*S/(Km + S + K1*S^2) - D)*X"}, {"S", "D*(Sf - S) - mumax*S/(Km + S + K1*S^2)*X/Y"}},
        .input = {.name = "D", .nominal = 0.3, .min = 0.0},
        .output = "X"};
}

/// Strong acid and strong base: a is the excess acid, mol/L, in the vessel.
inline NonlinearPlant ph_vessel(double a, double base_flow) {
    return {.states = {{"a", a}},
            .parameters = {{"V", 10.0}, {"Fa", 1.0}, {"Ca", 0.01}, {"Cb", 0.01}, {"Kw", 1e-14}},
            .equations = {{"a", "(Fa*(Ca - a) - u*(Cb + a))/V"}},
            .input = {.name = "u", .nominal = base_flow},
            .output = "-log(a/2 + sqrt(a^2/4 + Kw))/log(10)"};
}

/// A plant of one state x with nominal input 0.
inline NonlinearPlant scalar_plant(const std::string& rate, double x = 1, double u = 0) {
    return {.states = {{"x", x}},
            .parameters = {},
            .equations = {{"x", rate}},
            .input = {.name = "u", .nominal = u},
            .output = "x"};
}

inline NonlinearSystem made_system(const NonlinearPlant& plant) {
    auto system = NonlinearSystem::make(plant);
    if (!system) throw std::runtime_error(system.error().where + ": " + system.error().message);
    return *system;
}

}  // namespace tunewright
