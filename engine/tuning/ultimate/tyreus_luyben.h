// Tyreus and Luyben's rules from the ultimate gain and period.
#pragma once

#include "engine/tuning/method/ultimate_rule.h"

namespace tunewright {

struct TyreusLuybenOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    UltimateOptions point = {};
    FilterOptions filter = {};
};

/// More damped than Ziegler and Nichols' rules and with a long integral time: made for lag-dominated and integrating
/// plants.
///
///     PI    Kp = Ku/3.2   Ti = 2.2 Pu
///     PID   Kp = Ku/2.2   Ti = 2.2 Pu   Td = Pu/6.3
///
/// Filter of the PID: derivative, Tf = Td/10 (the sources have none).
///
/// Errors: those of chosen_ultimate_point(). Warns `outside-validity` for 1/(K Ku) above 0.5 (a large dead time, for
/// which the integral time is much too long), and those of ultimate_warnings().
///
/// Sources: Tyreus & Luyben, Ind. Eng. Chem. Res. 31 (1992) 2625-2628 (PI); Luyben & Luyben, Essentials of Process
/// Control (1997) (PID).
TuningMethod tyreus_luyben_method();

}  // namespace tunewright
