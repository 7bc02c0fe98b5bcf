// SIMC: Skogestad's rules on a half-rule model.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct SimcOptions {
    ControllerKind controller = ControllerKind::PID;
    std::optional<double> tau_c = {};  ///< desired closed-loop time constant; empty: the model's dead time
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// PI on a first-order, PID on a second-order model, in the series form Kp (1 + 1/(s Ti)) (1 + s Td):
///
///     stable               Kp = T1/(K (tau_c + L))       Ti = min(T1, 4 (tau_c + L))   Td = T2
///     integrating, lag T   Kp = 1/(K (tau_c + L))        Ti = 4 (tau_c + L)            Td = T
///     double integrating   Kp = 1/(4 K (tau_c + L)^2)    Ti = Td = 4 (tau_c + L)
///
/// The series form is converted exactly to the ideal form, Ti + Td, Ti Td/(Ti + Td) and Kp (1 + Td/Ti), whose
/// derivative is then filtered with Tf = Td/10: a tenth of the series Td, as in the source, would be slower than the
/// loop itself for two lags much longer than the dead time. For a pure dead time the rule gives pure integral action,
/// which the ideal form cannot represent: unsupported.
///
/// Errors: those of half_rule_model(); unsupported for L = 0 without tau_c. Warns `outside-validity` for tau_c < L and
/// for a second lag below L, `no-derivative` if there is no second lag.
///
/// Source: Skogestad, J. Process Control 13 (2003) 291-309, Table 1, Eqs. 23-29.
TuningMethod simc_method();

}  // namespace tunewright
