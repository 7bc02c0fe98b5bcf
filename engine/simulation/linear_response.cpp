#include "engine/simulation/linear_response.h"

#include "engine/simulation/response_run.h"

namespace tunewright {

LinearResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                               const ResponseOptions& options) {
    return run_response(plant, controller, nullptr, inputs, options);
}

}  // namespace tunewright
