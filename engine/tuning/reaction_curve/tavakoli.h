// Tavakoli and Tavakoli's PID for set-point steps, by dimensional analysis.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PID with the least ISE, IAE or ITAE of a set-point step on a first-order model with dead time, in q = L/T:
///
///     ISE    Kp = (0.3 q + 0.75)/(K (q + 0.05))   Ti = 2.4 L/(q + 0.4)               Td = L/(90 q)
///     IAE    Kp = 1/(K (q + 0.2))                 Ti = L (0.3 q + 1.2)/(q + 0.08)    Td = L/(90 q)
///     ITAE   Kp = 0.8/(K (q + 0.1))               Ti = L (0.3 + 1/q)                 Td = 0.06 L/(q + 0.04)
///
/// In the only known table (Jin & Son 2019, Table 1) the columns with the headings Ti/tau and Td/tau contain Ti/L and
/// Td/L: only this reproduces its nine published settings. Those have a pure derivative: filter {"Tf_over_Td": 0}.
///
/// All three methods have FirstOrderOptions: the reduction to the model (tangent first) and the derivative's filter, Tf
/// = Td/10 if not given.
///
/// Errors: those of tune_first_order(): a model without lag or dead time, and an integrating plant, are unsupported.
/// Warns `outside-validity` for L/T outside 0.1 to 2.
///
/// Source: Tavakoli & Tavakoli, Proc. 4th Int. Conf. Control and Automation (2003) 942-946.
TuningMethod tavakoli_ise_method();
TuningMethod tavakoli_iae_method();
TuningMethod tavakoli_itae_method();

}  // namespace tunewright
