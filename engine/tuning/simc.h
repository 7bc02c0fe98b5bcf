// SIMC: Skogestad's rules on a half-rule model.
#pragma once

#include "engine/tuning/method.h"

namespace tunewright {

/// PI on a first-order, PID on a second-order model (also integrating, integrating with lag, double integrating).
/// Option tau_c, the desired closed-loop time constant, defaults to L. The source's series form, its filtered lead
/// included, is answered exactly in the ideal form; filter: derivative, Tf = 0.1 of the series Td. A pure dead time
/// gets pure integral action, which the ideal form cannot carry: unsupported. Source: Skogestad, J. Process Control 13
/// (2003) 291-309, Table 1, Eqs. 23-29.
TuningMethod simc_method();

}  // namespace tunewright
