// Cohen and Coon's rules: quarter-amplitude damping with the dead time taken into account.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// P, PI, PID with dominant poles of decay ratio 1/4; q = L/T from 0.1 to 1. Oscillatory: Ms is typically above 2. T of
/// a plant of other form is static gain over steepest slope, as on the reaction curve of the source. Source: Cohen &
/// Coon, Trans. ASME 75 (1953) 827-834.
TuningMethod cohen_coon_method();

}  // namespace tunewright
