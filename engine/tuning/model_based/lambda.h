// Lambda tuning: the closed loop is asked to be a lag of time constant lambda behind the dead time.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI (Ti = T) and PID (dead time as a first-order Pade term, in the design only). Option lambda defaults to max(T, L),
/// to sqrt(10) L with an integrator (Chien & Fruehauf's choice). PID filter: derivative, Tf = Td/10. Sources: Rivera,
/// Morari & Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265, Table II; Astrom & Hagglund (2006),
/// Section 6.5; integrating: Chien & Fruehauf, Chem. Eng. Prog. 86 (1990) 33-41.
TuningMethod lambda_method();

}  // namespace tunewright
