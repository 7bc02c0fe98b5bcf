#include "engine/simulation/linear/linear_response.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation/linear/linear_run.h"
#include "engine/simulation/linear/mapped_steps.h"
#include "engine/simulation/linear/scaled_steps.h"
#include "engine/simulation/run/loop_sizes.h"

namespace tunewright {
namespace {

/// |y| of a response that grows without bound.
double beyond_bounds(const LinearPlant& plant, const ParallelPid& controller, const RunSetup& setup, double delta_r) {
    const LoopSizes sizes = loop_sizes(own_gain(plant, controller), controller, setup.system.in);
    return kMaxResponseRatio * std::max({delta_r, std::abs(setup.steady.y), sizes.y});
}

StepResponse run_mapped(const RunSetup& setup, const ResponseOptions& options) {
    const auto known = options.repeat != nullptr ? options.repeat->propagator : nullptr;
    return LinearRun<MappedSteps>(setup, options, known).run();
}

}  // namespace

StepResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                             const ResponseOptions& options) {
    return run_mapped(set_up_run(plant, controller, inputs, options.repeat), options);
}

StepResponse simulate_npid(const LinearPlant& plant, const ParallelPid& linear_part, double delta_r,
                           const StepInputs& inputs, const ResponseOptions& options) {
    const RunSetup setup = set_up_run(plant, linear_part, inputs, options.repeat);
    if (setup.system.s.integral_state < 0) return run_mapped(setup, options);
    return LinearRun<ScaledSteps>(setup, options, ErrorScaling{delta_r},
                                  beyond_bounds(plant, linear_part, setup, delta_r))
        .run();
}

}  // namespace tunewright
