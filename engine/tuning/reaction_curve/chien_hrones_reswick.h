// Chien, Hrones and Reswick's rules: a choice between set point and load, and of the overshoot.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// P, PI, PID for the fastest response to a set-point (`mode` servo) or load step (regulation, the default) with 0 or
/// 20 % overshoot; a = K L/T, L/T from 0.1 to 1. The regulation settings need a and L alone and serve integrating
/// plants with a = K L; the servo PI and PID need T. T of a plant of other form is static gain over steepest slope.
/// Source: Chien, Hrones & Reswick, Trans. ASME 74 (1952) 175-185, constants as rounded by Astrom & Hagglund (1995).
TuningMethod chien_hrones_reswick_method();

}  // namespace tunewright
