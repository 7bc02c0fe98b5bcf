// Ho, Hang and Cao's rules for a specified gain and phase margin.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct GainPhaseMarginOptions {
    ControllerKind controller = ControllerKind::PID;
    double gain_margin = 3;  ///< Am > 1, a factor
    double phase_margin_deg = 60;
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// PI on a first-order, PID (series form, converted to the ideal form) on a second-order model with dead time, for
/// `gain_margin` Am and `phase_margin_deg` phi:
///
///     omega_p = (Am phi + pi Am (Am - 1)/2)/((Am^2 - 1) L)
///     Kp = omega_p T1/(Am K)
///     Ti = 1/(2 omega_p - 4 omega_p^2 L/pi + 1/T1)
///     Td = T2
///
/// The arctangents in the equations of the margins are approximated by straight lines, so both margins are accurate to
/// some percent.
///
/// Errors: those of half_rule_model(); unsupported for a model without lag or dead time; invalid_argument for margins
/// that contradict each other (a negative Ti), with a phase margin that fits the gain margin.
///
/// Source: Ho, Hang & Cao, Automatica 31 (1995) 497-502.
TuningMethod gain_phase_margin_method();

}  // namespace tunewright
