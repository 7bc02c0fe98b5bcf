// Zhuang and Atherton's settings by time-weighted squared errors.
#pragma once

#include "engine/tuning/method/first_order_rule.h"
#include "engine/tuning/reaction_curve/error_integral_rules.h"

namespace tunewright {

struct ZhuangAthertonOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::iste;
    Mode mode = Mode::servo;
    FirstOrderOptions model = {};
};

/// PI and PID with the least integral of (t^n e)^2, n = 0 (ise) or 1 (iste), of a set-point (`mode` servo) or load step
/// (regulation) on a first-order model with dead time:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T/(a2 + b2 L/T) (servo), T (L/T)^b2/a2 (regulation)
///     Td = a3 T (L/T)^b3
///
/// Two tables, for L/T from 0.1 to 1 and from 1.1 to 2; between them the first is taken up to 1, the second above. The
/// set-point PID was fitted with the derivative on the error; here it acts on the measurement.
///
/// Source: Zhuang & Atherton, IEE Proc. D 140 (1993) 216-224, Tables 1 to 4, known to us from the textbooks that carry
/// them.
TuningMethod zhuang_atherton_method();

}  // namespace tunewright
