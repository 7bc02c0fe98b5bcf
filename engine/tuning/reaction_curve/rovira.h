// Rovira, Murrill and Smith's settings for set-point steps.
#pragma once

#include "engine/tuning/method/first_order_rule.h"
#include "engine/tuning/reaction_curve/error_integral_table.h"

namespace tunewright {

struct RoviraOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::itae;
    FirstOrderOptions model = {};
};

/// PI and PID with the least IAE or ITAE of a set-point step on a first-order model with dead time, for L/T from 0.1 to
/// 1:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T/(a2 + b2 L/T)
///     Td = a3 T (L/T)^b3
///
/// with the constants of the criterion from a table.
///
/// Source: Rovira, Murrill & Smith, Instruments & Control Systems 42 (1969) 67-69, known to us from the textbooks that
/// carry its table.
TuningMethod rovira_method();

}  // namespace tunewright
