// Lopez, Miller, Smith and Murrill's settings for load steps.
#pragma once

#include "engine/tuning/method/first_order_rule.h"
#include "engine/tuning/reaction_curve/error_integral_table.h"

namespace tunewright {

struct LopezOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::iae;
    FirstOrderOptions model = {};
};

/// P, PI, PID with the least ISE, IAE or ITAE of a load step on a first-order model with dead time, for L/T from 0.1 to
/// 1:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T (L/T)^b2/a2
///     Td = a3 T (L/T)^b3
///
/// with the constants of the criterion from a table. Robustness plays no part in it: Ms is often above 2.
///
/// Source: Lopez, Miller, Smith & Murrill, Instrumentation Technology 14 (1967) 57-62, known to us from the textbooks
/// that carry its table.
TuningMethod lopez_method();

}  // namespace tunewright
