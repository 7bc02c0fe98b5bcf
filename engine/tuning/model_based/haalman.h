// Haalman's rule: cancels the plant's lags, so that the loop is 2/(3 L s) e^(-Ls).
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct HaalmanOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// PI on a first-order, PID on a second-order model with dead time:
///
///     PI    Kp = 2 T/(3 K L)            Ti = T
///     PID   Kp = 2 (T1 + T2)/(3 K L)    Ti = T1 + T2    Td = T1 T2/(T1 + T2)
///
/// On such a plant the loop is 2/(3 L s) e^(-Ls) for all lags: Ms = 1.9 (without the derivative's filter). Cancelled
/// lags still appear in the response to loads, which is slow if they are long compared with the dead time.
///
/// Filter of the PID: derivative, Tf = Td/10 (the source has none).
///
/// Errors: those of half_rule_model(); unsupported for a model without lag or dead time and for integrating plants.
/// Warns `outside-validity` for L/T below 0.1, and `no-derivative` if a PID is requested and the model has one lag.
///
/// Source: Haalman, Control Engineering 12 (1965) 71-73.
TuningMethod haalman_method();

}  // namespace tunewright
