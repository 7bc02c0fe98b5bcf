// The PID controllers that are best for set points alone and for loads alone on a first-order model: the corner that
// no one controller reaches.
#pragma once

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// Both have b = 1, c = 0 and the derivative of the measurement filtered with Tf = Td/10.
struct IdealControllers {
    Pid servo;  ///< least IAE of a set-point step
    Pid load;   ///< least IAE of a load step
};

/// Short local searches from tabulated optima; the IAE on the model is within 1e-4 of the least one (mostly 1e-6). In
/// scaled form the answer depends on L/T alone.
///
/// Errors: unsupported where the model is not stable or has no dead time (no optimum: the higher the gain, the better)
/// and where L/T exceeds 50.
Expected<IdealControllers> ideal_controllers(const Fopdt& model);

}  // namespace tunewright
