// Tyreus and Luyben's rules from the ultimate gain and period.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI and PID, more damped than Ziegler and Nichols' and with a long integral time: made for lag-dominated and
/// integrating plants. Sources: Tyreus & Luyben, Ind. Eng. Chem. Res. 31 (1992) 2625-2628 (PI); Luyben & Luyben,
/// Essentials of Process Control (1997) (PID).
TuningMethod tyreus_luyben_method();

}  // namespace tunewright
