// AMIGO from the ultimate point and the static gain.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI and PID in kappa = 1/(K Ku), 0 for integrating plants, near 1 for pure dead time. Filter: second order on the
/// measurement. Source: Astrom & Hagglund, J. Process Control 14 (2004) 635-650, and Advanced PID Control (2006),
/// chapter 7.
TuningMethod amigo_ultimate_method();

}  // namespace tunewright
