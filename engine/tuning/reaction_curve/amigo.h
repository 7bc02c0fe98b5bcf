// AMIGO: PI and PID settings that were fitted to robust optima over a batch of 134 plants.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct AmigoOptions {
    ControllerKind controller = ControllerKind::PID;
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// First-order model with dead time L > 0 (T = 0 is allowed) or integrator with dead time, from the tangent and the 63
/// % time:
///
///     PI    Kp = 0.15/K + (0.35 - L T/(L + T)^2) T/(K L)
///           Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)
///     PID   Kp = (0.2 + 0.45 T/L)/K
///           Ti = L (0.4 L + 0.8 T)/(L + 0.1 T)
///           Td = 0.5 L T/(0.3 L + T)
///     integrating PI    Kp = 0.35/(K L)   Ti = 13.4 L
///     integrating PID   Kp = 0.45/(K L)   Ti = 8 L   Td = 0.5 L
///
/// PID: set-point weight b = 0 for L/(L + T) <= 0.5, else 1; PI: b = 1. PID filter: measurement_second_order, Tf =
/// Td/10.
///
/// Sources: PI: Hägglund & Åström, Asian J. Control 4 (2002); PID: Hägglund & Åström, J. Process Control 14 (2004),
/// Eqs. 12-15; both: Åström & Hägglund, Advanced PID Control (2006), Section 7.
TuningMethod amigo_method();

/// The same without a request. Errors: those of reduce(); unsupported for L = 0.
Expected<TunedController> tune_amigo(const TuningProblem& problem, const AmigoOptions& options);

}  // namespace tunewright
