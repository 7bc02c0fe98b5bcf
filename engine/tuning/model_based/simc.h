// SIMC: Skogestad's rules on a half-rule model.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI on a first-order, PID on a second-order model (also integrating, integrating with lag, double integrating).
/// Option tau_c, the desired closed-loop time constant, defaults to L. The source's series form is answered exactly in
/// the ideal form, Ti + Td, Ti Td/(Ti + Td) and Kp (1 + Td/Ti), whose derivative is then filtered with Tf = Td/10: a
/// tenth of the series Td, as the source has it, would be slower than the loop itself for two lags far above the dead
/// time. A pure dead time gets pure integral action, which the ideal form cannot carry: unsupported.
///
/// Source: Skogestad, J. Process Control 13 (2003) 291-309, Table 1, Eqs. 23-29.
TuningMethod simc_method();

}  // namespace tunewright
