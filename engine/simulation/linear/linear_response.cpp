#include "engine/simulation/linear/linear_response.h"

#include "engine/simulation/linear/response_run.h"

namespace tunewright {

StepSchedule halved(const StepSchedule& schedule) {
    StepSchedule finer{.h0 = schedule.h0 / 2, .level = {}, .to_horizon = 2 * schedule.to_horizon};
    finer.level.reserve(2 * schedule.level.size());
    for (const auto level : schedule.level) finer.level.insert(finer.level.end(), 2, level);
    return finer;
}

StepResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                             const ResponseOptions& options) {
    return run_response(plant, controller, nullptr, inputs, options);
}

}  // namespace tunewright
