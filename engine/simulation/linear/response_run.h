// The run behind the responses of loops with and without a nonlinear integral.
#pragma once

#include "engine/controller/error_scaling.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// `scaling` null: the linear loop. See linear_response.h and npid_response.h.
StepResponse run_response(const LinearPlant& plant, const ParallelPid& controller, const ErrorScaling* scaling,
                          const StepInputs& inputs, const ResponseOptions& options);

}  // namespace tunewright
