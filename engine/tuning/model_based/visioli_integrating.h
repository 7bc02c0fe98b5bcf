// Visioli's PID for integrating plants.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PID with the least integral of (t^n e)^2 of a load step on K e^(-Ls)/s: n = 0 (ise), 1/2 (itse), 1 (istse). No
/// robustness in it. Source: Visioli, IEE Proc. Control Theory Appl. 148 (2001) 180-184.
TuningMethod visioli_integrating_method();

}  // namespace tunewright
