// Ziegler and Nichols' step-response rules, for comparison.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct ZieglerNicholsStepOptions {
    ControllerKind controller = ControllerKind::PID;  ///< P, PI or PID
    ReductionOptions reduction = {};                  ///< tangent, with T by slope, if not given
    FilterOptions filter = {};
};

/// From the tangent at the steepest point of the step response, a = K L/T with T = K/slope (the reaction curve's own
/// construction, not the 63 % time); integrating: a = K L:
///
///     P     Kp = 1/a
///     PI    Kp = 0.9/a   Ti = L/0.3
///     PID   Kp = 1.2/a   Ti = 2 L     Td = 0.5 L
///
/// The rule aims at quarter-amplitude damping: Ms is typically above 2. PID filter: derivative, Tf = Td/10 (the source
/// has none).
///
/// Errors: those of rule_model(); unsupported for L = 0 and T = 0. Warns `outside-validity` for L/T outside 0.1 to 1.
///
/// Source: Ziegler & Nichols, Trans. ASME 64 (1942) 759-768.
TuningMethod ziegler_nichols_step_method();

}  // namespace tunewright
