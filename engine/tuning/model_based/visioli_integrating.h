// Visioli's PID for integrating plants.
#pragma once

#include "engine/tuning/method/rule.h"
#include "engine/tuning/reaction_curve/error_integral_table.h"

namespace tunewright {

struct VisioliIntegratingOptions {
    FittedCriterion criterion = FittedCriterion::istse;
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// K L Kp, Ti/L, Td/L: 1.34, 1.83, 0.49 (istse); 1.36, 1.66, 0.53 (itse); 1.37, 1.49, 0.59 (ise).
///
/// PID with the least integral of (t^n e)^2 of a load step on K e^(-Ls)/s: n = 0 (ise), 1/2 (itse), 1 (istse). No
/// robustness in it. Source: Visioli, IEE Proc. Control Theory Appl. 148 (2001) 180-184.
TuningMethod visioli_integrating_method();

}  // namespace tunewright
