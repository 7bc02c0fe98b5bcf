// Plants given by equations whose behaviour varies over their range.
#pragma once

#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright::range_tests {

/// A conical tank with an inlet pipe and free outflow: dh/dt = (q - c sqrt(h))/(pi (R/H)^2 h^2), R = 18 cm at H = 60
/// cm. The gain of the steady level to the inflow is 2 sqrt(h)/c, that of its rate 1/(pi (R/H)^2 h^2).
inline NonlinearPlant conical_tank(double h) {
    return {.states = {{"h", h}},
            .parameters = {{"c", 40.0}, {"a", 0.09 * 3.14159265358979323846}},
            .equations = {{"h", "(q - c*sqrt(h))/(a*h^2)"}},
            .input = {.name = "q", .nominal = 40.0 * __builtin_sqrt(h), .min = 0.0, .max = 400.0},
            .output = "h",
            .L = 2};
}

/// A CSTR cooled by the flow qc of its coolant: Nahas, Henson and Seborg, Computers & Chemical Engineering 16 (1992)
/// 1039-1057; q = 100 l/min. At rest CA = 0.1 mol/l, T = 438.5 K at qc = 103.4 l/min.
inline NonlinearPlant coolant_reactor() {
    return {.states = {{"CA", 0.1}, {"T", 438.54}},
            .parameters = {{"q", 100.0},
                           {"V", 100.0},
                           {"CA0", 1.0},
                           {"T0", 350.0},
                           {"Tc0", 350.0},
                           {"k0", 7.2e10},
                           {"ER", 1e4},
                           {"H", 2e5},
                           {"rc", 1000.0},
                           {"hA", 7e5}},
            .equations = {{"CA", "q/V*(CA0 - CA) - k0*exp(-ER/T)*CA"},
                          {"T", "q/V*(T0 - T) + H/rc*k0*exp(-ER/T)*CA + qc/V*(1 - exp(-hA/(qc*rc)))*(Tc0 - T)"}},
            .input = {.name = "qc", .nominal = 103.41, .min = 1.0, .max = 300.0},
            .output = "CA",
            .L = 0.1};
}

/// A CSTR cooled by a jacket of temperature Tc, time in h: Bequette, Process Dynamics (1998), module 9, case 2. Three
/// steady states at Tc = 298 K: T = 311.2, 339.1 and 368.1 K.
inline NonlinearPlant jacketed_reactor() {
    return {.states = {{"CA", 8.564}, {"T", 311.2}},
            .parameters = {{"k0", 34930800.0},
                           {"E", 11843.0},
                           {"Rg", 1.987},
                           {"CAf", 10.0},
                           {"Tf", 298.0},
                           {"J", 11.92},
                           {"UA", 0.3}},
            .equations = {{"CA", "CAf - CA - k0*exp(-E/(Rg*T))*CA"},
                          {"T", "Tf - T + J*k0*exp(-E/(Rg*T))*CA + UA*(Tc - T)"}},
            .input = {.name = "Tc", .nominal = 298.0, .min = 200.0, .max = 400.0},
            .output = "T",
            .L = 0.02};
}

/// Strong acid (u) into a strong base, pH of a stirred vessel seen through an electrode with a lag; McAvoy, Hsu and
/// Lowenthal, Ind. Eng. Chem. Process Des. Dev. 11 (1972) 68-70. w: base less acid, mol/l.
inline NonlinearPlant neutralisation(double u) {
    const double w = (0.01 - 0.01 * u) / (1 + u);
    return {.states = {{"w", w}, {"z", w}},
            .parameters = {{"V", 10.0}, {"F", 1.0}, {"Cb", 0.01}, {"Ca", 0.01}, {"Kw", 1e-14}, {"Te", 0.5}},
            .equations = {{"w", "(F*Cb - u*Ca - (F + u)*w)/V"}, {"z", "(w - z)/Te"}},
            .input = {.name = "u", .nominal = u, .min = 0.0, .max = 3.0},
            .output = "log((z + sqrt(z^2 + 4*Kw))/(2*Kw))/log(10)",
            .L = 0.5};
}

}  // namespace tunewright::range_tests
