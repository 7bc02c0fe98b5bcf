// The response of a nonlinear plant under a controller that computes once every sample time.
#pragma once

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {

/// As on a linear plant (sampled_response.h); the equations are integrated between the changes of their input
/// (nonlinear/plant_run.h). `settles` is false also where the states leave the domain of the equations. The rest is the
/// operating point plus what the set point asks for: y rests at r with integral action, else where it stays.
StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options);

}  // namespace tunewright
