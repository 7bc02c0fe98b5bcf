// AMIGO: PI and PID settings that were fitted to robust optima over a batch of 134 plants.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// First-order model with dead time L > 0 (T = 0 is allowed) or integrator with dead time, from the tangent and the 63
/// % time. PID: set-point weight b = 0 for L/(L + T) <= 0.5, else 1; PI: b = 1. PID filter: measurement_second_order,
/// Tf = Td/10. Sources: PI: Hagglund & Astrom, Asian J. Control 4 (2002); PID: Hagglund & Astrom, J. Process Control 14
/// (2004), Eqs. 12-15; both: Astrom & Hagglund, Advanced PID Control (2006), Section 7.
TuningMethod amigo_method();

}  // namespace tunewright
