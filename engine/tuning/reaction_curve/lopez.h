// Lopez, Miller, Smith and Murrill's settings for load steps.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// P, PI, PID with the least ISE, IAE or ITAE of a load step on a first-order model with dead time, as power laws in
/// L/T; for L/T from 0.1 to 1. No robustness in it: Ms is often above 2. Source: Lopez, Miller, Smith & Murrill,
/// Instrumentation Technology 14 (1967) 57-62, known to us from the textbooks that carry its table.
TuningMethod lopez_method();

}  // namespace tunewright
