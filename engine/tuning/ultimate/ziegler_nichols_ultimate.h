// Ziegler and Nichols' rules from the ultimate gain and period, and their later variants.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// P, PI, PID as shares of Ku and Pu. `variant` of the PID: classic; pessen, Pessen's integral rule; some_overshoot and
/// no_overshoot, which give up gain for damping. Any linear plant that a proportional gain brings to oscillation. The
/// classic rule aims at quarter-amplitude damping: Ms is typically above 2. Sources: Ziegler & Nichols, Trans. ASME 64
/// (1942) 759-768; Pessen, J. Dyn. Syst. Meas. Control 116 (1994) 553-557; the two overshoot variants are those of
/// Perry & Chilton, Chemical Engineers' Handbook (1973), as the textbooks give them. Range of K Ku: Hang, Astrom & Ho,
/// IEE Proc. D 138 (1991) 111-118.
TuningMethod ziegler_nichols_ultimate_method();

}  // namespace tunewright
