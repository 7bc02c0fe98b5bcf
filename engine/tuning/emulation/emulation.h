// A PID that emulates a nonlinear controller on a nonlinear plant, within bounds from classical tunings.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// Two levels. First: classical settings from step and relay tests simulated on the plant and from its linearisation;
/// they give bounds on Kp, Ti, Td (Eq. 3). Second: the PID within them whose runs are closest to those of an
/// input/output linearising controller (Eq. 2), by simulation of both or approximately (Remark 6). Linear plants are
/// supported too.
///
/// Source: Mhaskar, El-Farra and Christofides, "A method for PID controller tuning using nonlinear control techniques",
/// American Control Conference 2004; Eq. 8 with its middle term corrected. Errors: invalid_argument with the option as
/// `where` (a target that does not suit the relative degree, unknown states); those of relative_degree();
/// no_feasible_controller if the first level finds nothing, or if no PID within the bounds reaches the horizon;
/// unsupported if the nonlinear controller itself does not; cancelled.
TuningMethod emulation_method();
inline constexpr const char* kEmulation = "emulation";  ///< its id

}  // namespace tunewright
