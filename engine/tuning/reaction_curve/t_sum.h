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

/// K is the static gain, T_sum the sum of the lags minus the leads plus the dead time: the area between the step
/// response and its end value over K. Both are the plant's own, so that no reduced model is needed.
///
///     normal   P    Kp = 1/K
///              PI   Kp = 0.5/K   Ti = 0.5 T_sum
///              PID  Kp = 1/K     Ti = 0.66 T_sum   Td = 0.167 T_sum
///     fast     PI   Kp = 1/K     Ti = 0.7 T_sum
///              PID  Kp = 2/K     Ti = 0.8 T_sum    Td = 0.194 T_sum
///
/// Source: Kuhn, Automatisierungstechnische Praxis 37 (1995) 10-16, taken from textbooks that contain its table.
/// Errors: unsupported for unstable and integrating plants and for T_sum <= 0; invalid_argument for a fast P
/// controller.
TuningMethod t_sum_method();

}  // namespace tunewright
