// The PID law as a program computes it once every sample time, with the rules for its integral and derivative. Gains,
// weights and filter are those of the continuous law (pid.h), which is its limit for a sample time of 0.
//
// At t_k = k Ts the program reads r_k and y_k, and its output is held until the next one (zero-order hold), from
// t_k + `computation_delay` on. Everything is at rest, and 0, before k = 0. With e = r - y_f and f = c r - y_f:
//
//   u_k = Kp (b r_k - y_f,k) + I_k + D_k
//
//   I   backward     I_k = I_{k-1} + Ki Ts e_k
//       forward      I_k = I_{k-1} + Ki Ts e_{k-1}
//       trapezoidal  I_k = I_{k-1} + Ki Ts (e_k + e_{k-1})/2
//
//   D   difference            D_k = Kd (f_k - f_{k-1})/Ts
//       filtered, backward    D_k = (Tf D_{k-1} + Kd (f_k - f_{k-1}))/(Tf + Ts)
//       filtered, forward     D_k = (1 - Ts/Tf) D_{k-1} + Kd (f_{k} - f_{k-1})/Tf
//       filtered, trapezoidal D_k = ((2 Tf - Ts) D_{k-1} + 2 Kd (f_k - f_{k-1}))/(2 Tf + Ts)
//       slope                 D_k = Kd (f_k - f_{k-M})/(M Ts)
//       four points           D_k = Kd (3 f_k + f_{k-1} - f_{k-2} - 3 f_{k-3})/(10 Ts)
//
//   y_f by backward Euler: of the first order y_f,k = (Tf y_f,k-1 + Ts y_k)/(Tf + Ts); of the second, with v = dy_f/dt,
//       v_k = (v_{k-1} + (2 Ts/Tf^2)(y_k - y_f,k-1))/(1 + 2 Ts/Tf + 2 (Ts/Tf)^2),   y_f,k = y_f,k-1 + Ts v_k.
//   By trapezoids, where `trapezoidal_filter` says so: y_f, and the derivative of y_f with it, are the continuous ones
//   with s = (2/Ts)(z - 1)/(z + 1).
//
// The set point's filter by backward Euler: r_f,k = (T r_f,k-1 + Ts r_k)/(T + Ts) takes the place of r_k. A velocity
// algorithm adds the increments of the same sum to its last output: within limits the output is the same. Sources:
// Åström and Wittenmark, Computer-Controlled Systems (3rd ed. 1997), section 8.5; Åström and Hägglund, Advanced PID
// Control (2006), section 13.3. Slope and four points: the programs that use them (product/).
#pragma once

#include "engine/controller/pid.h"

namespace tunewright {

enum class IntegralRule { backward, forward, trapezoidal };

enum class DerivativeRule {
    difference,            ///< unfiltered, even if the gains have a filter
    filtered_backward,     ///< with the gains' `derivative` filter; without one the difference
    filtered_forward,      ///< the same by the forward rule; stable only for Tf > Ts/2
    filtered_trapezoidal,  ///< the same
    slope,                 ///< over `slope_samples` periods; no filter
    four_points,           ///< no filter
};

struct SampledPid {
    ParallelPid gains;
    double Ts = 0;  ///< > 0, time
    IntegralRule integral = IntegralRule::backward;
    DerivativeRule derivative = DerivativeRule::filtered_backward;
    int slope_samples = 1;         ///< M >= 1
    double computation_delay = 0;  ///< >= 0, time; may be longer than Ts
    bool velocity = false;
    bool trapezoidal_filter = false;  ///< trapezoidal filter of the measurement
};

/// True if the measurement's filter and the derivative are computed together, by the trapezoidal rule.
inline bool whole_by_trapezoids(const SampledPid& law) {
    const FilterType type = law.gains.filter.type;
    return law.trapezoidal_filter &&
           (type == FilterType::measurement_first_order || type == FilterType::measurement_second_order);
}

}  // namespace tunewright
