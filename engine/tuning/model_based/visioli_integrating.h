// Visioli's PID for integrating plants.
#pragma once

#include "engine/tuning/method/rule.h"
#include "engine/tuning/reaction_curve/error_integral_rules.h"

namespace tunewright {

struct VisioliIntegratingOptions {
    FittedCriterion criterion = FittedCriterion::istse;  ///< ise, itse or istse
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// PID with the least integral of (t^n e)^2 of a load step on K e^(-Ls)/s, n = 0 (ise), 1/2 (itse), 1 (istse):
///
///     istse   Kp = 1.34/(K L)   Ti = 1.83 L   Td = 0.49 L
///     itse    Kp = 1.36/(K L)   Ti = 1.66 L   Td = 0.53 L
///     ise     Kp = 1.37/(K L)   Ti = 1.49 L   Td = 0.59 L
///
/// The rule does not consider robustness.
///
/// Filter of the PID: derivative, Tf = Td/10 (the source has none).
///
/// Errors: those of rule_model(); unsupported for a plant that does not integrate once and for L = 0.
///
/// Source: Visioli, IEE Proc. Control Theory Appl. 148 (2001) 180-184.
TuningMethod visioli_integrating_method();

}  // namespace tunewright
