// Cohen and Coon's rules: quarter-amplitude damping, with the dead time taken into account.
#pragma once

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {

struct CohenCoonOptions {
    ControllerKind controller = ControllerKind::PID;  ///< P, PI or PID
    FirstOrderOptions model = {};
};

/// Dominant poles of decay ratio 1/4; q = L/T from 0.1 to 1:
///
///     P     Kp = (1 + q/3)/(K q)
///     PI    Kp = (0.9 + q/12)/(K q)    Ti = L (30 + 3 q)/(9 + 20 q)
///     PID   Kp = (4/3 + q/4)/(K q)     Ti = L (32 + 6 q)/(13 + 8 q)     Td = 4 L/(11 + 2 q)
///
/// The loop is oscillatory: Ms is typically above 2. T of a plant of other form is static gain over steepest slope, as
/// on the reaction curve of the source.
///
/// Filter of the PID: derivative, Tf = Td/10 (the source has none).
///
/// Errors: those of tune_first_order(): a model without lag or dead time, and an integrating plant, are unsupported.
/// Warns `outside-validity` for L/T outside 0.1 to 1.
///
/// Source: Cohen & Coon, Trans. ASME 75 (1953) 827-834.
TuningMethod cohen_coon_method();

}  // namespace tunewright
