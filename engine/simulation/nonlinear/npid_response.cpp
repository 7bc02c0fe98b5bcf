#include "engine/simulation/nonlinear/npid_response.h"

#include "engine/simulation/linear/response_run.h"

namespace tunewright {

StepResponse simulate_npid(const LinearPlant& plant, const ParallelPid& linear_part, double delta_r,
                           const StepInputs& inputs, const ResponseOptions& options) {
    const ErrorScaling scaling{delta_r};
    return run_response(plant, linear_part, &scaling, inputs, options);
}

}  // namespace tunewright
