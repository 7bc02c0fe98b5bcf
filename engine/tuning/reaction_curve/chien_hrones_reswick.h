// Chien, Hrones and Reswick's rules: for set points or loads, with a choice of the overshoot.
#pragma once

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {

enum class DesignOvershoot { none, twenty_percent };

struct ChienHronesReswickOptions {
    ControllerKind controller = ControllerKind::PID;
    Mode mode = Mode::regulation;
    DesignOvershoot overshoot = DesignOvershoot::none;
    FirstOrderOptions model = {};
};

/// P, PI, PID for the fastest response to a set-point (`mode` servo) or load step (regulation, the default) with 0 or
/// 20 % overshoot; a = K L/T, L/T from 0.1 to 1:
///
///     regulation, 0 %     P  Kp = 0.3/a    PI  Kp = 0.6/a, Ti = 4 L       PID  Kp = 0.95/a, Ti = 2.4 L, Td = 0.42 L
///     regulation, 20 %    P  Kp = 0.7/a    PI  Kp = 0.7/a, Ti = 2.3 L     PID  Kp = 1.2/a, Ti = 2 L, Td = 0.42 L
///     servo, 0 %          P  Kp = 0.3/a    PI  Kp = 0.35/a, Ti = 1.2 T    PID  Kp = 0.6/a, Ti = T, Td = 0.5 L
///     servo, 20 %         P  Kp = 0.7/a    PI  Kp = 0.6/a, Ti = T         PID  Kp = 0.95/a, Ti = 1.4 T, Td = 0.47 L
///
/// The regulation settings need only a and L and also apply to integrating plants with a = K L; the servo PI and PID
/// need T. T of a plant of other form is static gain over steepest slope.
///
/// Source: Chien, Hrones & Reswick, Trans. ASME 74 (1952) 175-185, constants as rounded by Åström & Hägglund (1995).
TuningMethod chien_hrones_reswick_method();

}  // namespace tunewright
