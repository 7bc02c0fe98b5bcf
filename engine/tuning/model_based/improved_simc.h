// Grimholt and Skogestad's improvement of SIMC for plants with a large dead time.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct ImprovedSimcOptions {
    ControllerKind controller = ControllerKind::PID;
    std::optional<double> tau_c = {};  ///< desired closed-loop time constant; empty: L for PI, L/2 for PID
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// SIMC with T + L/3 in place of T for PI, and with a series derivative time L/3 for PID, converted to the ideal form;
/// on a first-order model (half rule), which may integrate or be a pure dead time:
///
///     PI           Kp = (T + L/3)/(K (tau_c + L))   Ti = min(T + L/3, 4 (tau_c + L))
///     PID, series  Kp = T/(K (tau_c + L))           Ti = min(T, 4 (tau_c + L))        Td = L/3
///     integrating  Kp = 1/(K (tau_c + L))           Ti = 4 (tau_c + L)
///
/// Filter of the PID: derivative, Tf = Td/10 (the source has none).
///
/// Errors: those of rule_model(); unsupported for a model without dead time. Warns `outside-validity` for tau_c below
/// its default.
///
/// Sources: Grimholt & Skogestad, IFAC Conf. Advances in PID Control (2012) for PI; J. Process Control 70 (2018) 36-46
/// for PID.
TuningMethod improved_simc_method();

}  // namespace tunewright
