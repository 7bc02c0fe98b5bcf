// Reduction by least integrated difference of step responses.
#pragma once

#include "engine/reduction/reduction.h"

namespace tunewright {

/// The first-order model with the least integral of |y - y_model| (min_iae), its square (min_ise) or itself times t
/// (min_itae) after a unit step, dead time included. Without request.horizon the integral runs to infinity: K is the
/// static gain, T and L are free. With it all three are free and the integral ends there, as in Jin & Son's reductions.
///
/// Integrating plants: K is the slope of their ramp. Without a horizon the integral is finite for L + T = ramp_delay()
/// alone: that is the first-order answer (T = 0), and leaves T free for second order. With one, L (and T) are free.
///
/// Found by a simplex and a subspace search from the models by two points and by tangent, over L and ln T; the
/// integral is within 1e-5 of the least one met from any start tried. Stable plants get first order whatever is asked.
/// Warns where the response is not essentially monotone, and where T exceeds the horizon.
///
/// Errors (the message is the bare reason, which reduce() puts into its sentence): unsupported where a ramp leads the
/// step; invalid_argument, `where` "reduction/horizon", where nothing has moved by the horizon.
/// Source: Jin & Son, Studies in Informatics and Control 28 (2019), Section 5.
Expected<ReducedModel> min_error(const LinearPlant& plant, const ReductionRequest& request);

}  // namespace tunewright
