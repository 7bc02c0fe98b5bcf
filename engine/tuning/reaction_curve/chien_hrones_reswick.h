// Chien, Hrones and Reswick's rules: a choice between set point and load, and of the overshoot.
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
/// 20 % overshoot; a = K L/T, L/T from 0.1 to 1. Of 0 %, regulation: P: Kp = 0.3/a; PI: 0.6/a, Ti = 4 L; PID: 0.95/a,
/// Ti = 2.4 L, Td = 0.42 L; servo: P: 0.3/a; PI: 0.35/a, Ti = 1.2 T; PID: 0.6/a, Ti = T, Td = 0.5 L. The regulation
/// settings need a and L alone and serve integrating plants with a = K L; the servo PI and PID need T. T of a plant of
/// other form is static gain over steepest slope. Source: Chien, Hrones & Reswick, Trans. ASME 74 (1952) 175-185,
/// constants as rounded by Astrom & Hagglund (1995).
TuningMethod chien_hrones_reswick_method();

}  // namespace tunewright
