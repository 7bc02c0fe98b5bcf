// The response of a linear plant under a controller that computes once every sample time: the plant exact between the
// samples, its dead time too.
//
// Between two changes of its input the plant moves by exact exponentials; nodes stand wherever y would leave the cubic
// through its neighbours by more than the tolerance, so that the indices of linear/indices.h are those of the
// continuous y, not of its samples. Set point and load step at t = 0, when the first sample is taken: y is still at
// rest then.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/controller/sampled/pid_program.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

struct SampledOptions {
    double tolerance = 1e-6;  ///< of the cubics between nodes, relative to the largest |y|
    double settled = 1e-8;    ///< ends when y and u stay this close to rest, relative to their largest deviation
    std::optional<double> horizon = {};  ///< ends exactly there instead
    int max_samples = 400000;
    std::stop_token stop = {};  ///< asked once every sample; the response then ends, unsettled
};

/// `u` of the nodes is what the program gives out, held, from the end of its computation delay on. `settles` is false
/// where `max_samples` came first, or where y is beyond any use. `error_integral_final` is what has been integrated
/// when y is at rest; with integral action only, and not where u rests at a limit. No errors: an unstable loop grows
/// until it ends.
StepResponse simulate_sampled(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options);

/// The same on a nonlinear plant, whose equations are integrated between the changes of their input
/// (nonlinear/plant_run.h). `settles` is false also where the states leave the domain of the equations. With integral
/// action y rests at r, else where it stays.
StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options);

}  // namespace tunewright
