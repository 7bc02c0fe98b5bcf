// Kuhn's T-sum rule: settings from the static gain and the sum of all times.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

enum class TSumSpeed { normal, fast };

struct TSumOptions {
    ControllerKind controller = ControllerKind::PID;
    TSumSpeed speed = TSumSpeed::normal;
    FilterOptions filter = {};
};

/// With K the static gain and T_sum the sum of the lags minus the leads plus the dead time, which is the area between
/// the step response and its end value over K: normal: P: Kp = 1/K; PI: Kp = 0.5/K, Ti = 0.5 T_sum; PID: Kp = 1/K, Ti =
/// 0.66 T_sum, Td = 0.167 T_sum; fast: P: none; PI: Kp = 1/K, Ti = 0.7 T_sum; PID: Kp = 2/K, Ti = 0.8 T_sum, Td = 0.194
/// T_sum. Stable plants; no reduced model is needed, because both figures are the plant's own.
///
/// Source: Kuhn, Automatisierungstechnische Praxis 37 (1995) 10-16, known to us from the textbooks that carry its
/// table.
TuningMethod t_sum_method();

}  // namespace tunewright
