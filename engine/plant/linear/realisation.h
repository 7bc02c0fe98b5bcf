// A state-space realisation of given zeros and poles, well conditioned for high orders.
#pragma once

#include "engine/plant/linear/factor.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// A cascade of first- and second-order sections, each of gain one where it has a finite static gain: 1/(s+1)^8 keeps
/// the digits that a companion form loses.
Realisation cascade(const Factors& factors);

}  // namespace tunewright
