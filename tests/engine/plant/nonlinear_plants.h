// Nonlinear plants that several tests look at.
#pragma once

#include <string>

#include "engine/plant/nonlinear_system.h"

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
