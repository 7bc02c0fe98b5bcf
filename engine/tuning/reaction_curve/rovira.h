// Rovira, Murrill and Smith's settings for set-point steps.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI and PID with the least IAE or ITAE of a set-point step on a first-order model with dead time; for L/T from 0.1 to
/// 1. Source: Rovira, Murrill & Smith, Instruments & Control Systems 42 (1969) 67-69, known to us from the textbooks
/// that carry its table.
TuningMethod rovira_method();

}  // namespace tunewright
