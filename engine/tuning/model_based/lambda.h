// Lambda tuning: the closed loop is to be a lag with time constant lambda and the dead time.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct LambdaOptions {
    ControllerKind controller = ControllerKind::PID;
    std::optional<double>
        lambda;  ///< desired closed-loop time constant; empty: max(T, L), sqrt(10) L with an integrator
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// PI, and PID with the dead time as a first-order Pade approximation in the design:
///
///     PI    Kp = T/(K (lambda + L))              Ti = T
///     PID   Kp = (2 T + L)/(K (2 lambda + L))    Ti = T + L/2    Td = T L/(2 T + L)
///     integrating PI    Kp = (2 lambda + L)/(K (lambda + L)^2)      Ti = 2 lambda + L
///     integrating PID   Kp = (2 lambda + L)/(K (lambda + L/2)^2)    Ti = 2 lambda + L
///                       Td = (lambda L + L^2/4)/(2 lambda + L)
///
/// PID filter: derivative, Tf = Td/10.
///
/// Sources: Rivera, Morari & Skogestad, Ind. Eng. Chem. Process Des. Dev. 25 (1986) 252-265, Table II; Åström &
/// Hägglund (2006), Section 6.5; integrating, and lambda = sqrt(10) L there: Chien & Fruehauf, Chem. Eng. Prog. 86
/// (1990) 33-41.
TuningMethod lambda_method();

}  // namespace tunewright
