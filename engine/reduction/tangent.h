// The tangent at the steepest point of the step response, as drawn since Ziegler and Nichols (1942), on the exact
// response.
#pragma once

#include "engine/reduction/reduction.h"

namespace tunewright {

/// See reduction.h; integrating plants: the ramp's asymptote, exactly. Errors (the message is the bare reason, which
/// reduce() puts into its sentence): unsupported, `where` "reduction/method", where the response jumps, where a lead
/// leaves no dead time, or where no tangent model with T > 0 exists.
Expected<ReducedModel> tangent(const LinearPlant& plant, TangentTime time);

}  // namespace tunewright
