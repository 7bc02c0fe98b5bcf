// Internal model control's PID on first- and second-order models.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// C = f/(G- (1 - G+ f)) with f = 1/(lambda s + 1)^n on G = K e^(-Ls)/(1 + n1 s + n2 s^2), one or two lags or an
/// oscillatory pair, as a PID:
///
/// maclaurin  the first three terms of the series of s C about 0, the dead time exact in it.
/// pade       the dead time first replaced: by its 1/1 Pade approximation on a first-order model, by 1 - L s on a
/// second-
///            order one; C is then a PID exactly, with a filter on its derivative where n = 2.
///
/// Sources: Morari and Zafiriou, Robust Process Control (1989); Rivera, Morari and Skogestad (1986), Table 1 (pade);
/// Liu and Gao (2008), Table 2 (maclaurin with n = 2 on the second-order process).
TuningMethod imc_method();

}  // namespace tunewright
