// Ziegler and Nichols' step-response rules: the classic, for comparison.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct ZieglerNicholsStepOptions {
    ControllerKind controller = ControllerKind::PID;
    ReductionOptions reduction = {};
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
/// Source: Ziegler & Nichols, Trans. ASME 64 (1942) 759-768.
TuningMethod ziegler_nichols_step_method();

}  // namespace tunewright
