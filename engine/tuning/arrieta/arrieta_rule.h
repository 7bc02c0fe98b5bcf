// The servo/regulation tuning rule of Arrieta, Vilanova and Alfaro: its constants and its formulas.
#pragma once

#include <span>

#include "engine/controller/pid.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// Constants of Eq. 7, with tau = L/T: Kp K = a1 tau^b1 + c1, Ti/T = a2 tau^b2 + c2, Td/T = a3 tau^b3 + c3.
struct ArrietaConstants {
    double a1, b1, c1;
    double a2, b2, c2;
    double a3, b3, c3;
};

/// One column of a table.
struct ArrietaLevel {
    double level = 0;  ///< Ms, or the allowed degradation
    ArrietaConstants constants;
};

/// Table 1, the column without a limit on Ms: the least J_rd.
const ArrietaConstants& arrieta_free();

/// Table 1, Ms = 1.4, 1.6, 1.8, 2.
std::span<const ArrietaLevel> arrieta_Ms_levels();

/// Table 2, allowed degradation 0 (the same as `arrieta_free`), 0.25, 0.35, 0.45, 0.55.
std::span<const ArrietaLevel> arrieta_degradation_levels();

/// Null if no column is within 1e-9 of `level`.
const ArrietaConstants* arrieta_column(std::span<const ArrietaLevel> table, double level);

constexpr double kArrietaLowestMs = 1.4, kArrietaHighestMs = 2;

enum class ArrietaC3 {
    printed,   ///< 0.1331 M^2 - 0.4733 M + 0.4032
    refitted,  ///< 0.1331 M^2 - 0.4320 M + 0.3330: the least-squares quadratic through Table 1
};

/// Eq. 9 for any Ms between the lowest and the highest. b3 is 1.3870 M^2 - 4.7810 M + 4.9470: with the printed 0.3870
/// it differs from Table 1 by 2 to 4, with 1.3870 by 0.04. The error of the printed c3 is 0.014 at both ends, where Td
/// then jumps by 38 to 48 % (tau = 0.1); that of the refitted one is 0.002 there and at most 0.006, 3.2 % of Td. Their
/// Ms differ by at most 1.7 % (tau = 0.1).
ArrietaConstants arrieta_equation_9(double Ms, ArrietaC3 c3);

/// PID with b = 1, c = 0 and the derivative of the measurement filtered with Tf = Td/10 (Eq. 1). `model` has T > 0, L >
/// 0. Not every result is a controller: Td < 0 for L/T below about 0.03 to 0.045.
///
/// Source: Arrieta, Vilanova and Alfaro, Performance degradation driven PID controller design, IFAC Conf. Advances in
/// PID Control PID'12 (2012), Eqs. 1, 7-9, Tables 1 and 2.
IdealPid arrieta_pid(const ArrietaConstants& constants, const Fopdt& model);

}  // namespace tunewright
