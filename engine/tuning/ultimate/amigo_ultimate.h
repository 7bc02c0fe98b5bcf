// AMIGO from the ultimate point and the static gain.
#pragma once

#include "engine/tuning/method/ultimate_rule.h"

namespace tunewright {

struct AmigoUltimateOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    UltimateOptions point = {};
    FilterOptions filter = {};
};

/// PI and PID in kappa = 1/(K Ku), 0 for integrating plants, near 1 for pure dead time:
///
///     PI    Kp = 0.16 Ku                     Ti = Pu/(1 + 4.5 kappa)
///     PID   Kp = (0.3 - 0.1 kappa^4) Ku      Ti = 0.6 Pu/(1 + 2 kappa)
///           Td = 0.15 Pu (1 - kappa)/(1 - 0.95 kappa)
///
/// Filter: second order on the measurement.
///
/// Errors: those of chosen_ultimate_point(); unsupported for unstable plants and if kappa is not from 0 to 1. Warns
/// `outside-validity` for a PID with kappa below 0.1: plants with so little dead time are poorly described by the
/// ultimate point.
///
/// Source: Åström & Hägglund, J. Process Control 14 (2004) 635-650, and Advanced PID Control (2006), chapter 7.
TuningMethod amigo_ultimate_method();

}  // namespace tunewright
