// Wang, Juang and Chan's PID for set-point steps.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// Kp = (0.7303 + 0.5307 T/L) (T + L/2)/(K (T + L)), Ti = T + L/2, Td = L T/(2 T + L): PID with the least ITAE of a
/// set-point step on a first-order model with dead time, Ti and Td those of an internal model controller; for L/T from
/// 0.05 to 6. Source: Wang, Juang & Chan, Chem. Eng. Communications 132 (1995) 15-34.
TuningMethod wang_juang_chan_method();

}  // namespace tunewright
