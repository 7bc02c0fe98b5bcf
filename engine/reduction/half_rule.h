// Skogestad's half rule: reduction from poles and zeros alone.
#pragma once

#include "engine/reduction/reduction.h"

namespace tunewright {

/// See reduction.h. Errors (the message is the bare reason, which reduce() puts into its sentence): unsupported,
/// `where` "reduction/method", for complex zeros, weakly damped poles, a lead without a lag to cancel.
Expected<ReducedModel> half_rule(const LinearPlant& plant, ReducedOrder order);

}  // namespace tunewright
