// The response of a linear plant with a controller that computes once every sample time: the plant and its dead time
// are exact between the samples.
//
// Between two changes of its input the plant moves by exact exponentials; nodes are added until y agrees with the
// cubics between them to the tolerance, so that the indices of linear/indices.h are those of the continuous y, not of
// its samples. Set point and load step at t = 0, when the first sample is taken: y is still at rest then.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/controller/sampled/pid_program.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

struct SampledOptions {
    double tolerance = 1e-6;  ///< error of the cubics between nodes, relative to the largest |y|
    double settled = 1e-8;    ///< ends when y and u stay this close to rest, relative to their largest deviation
    std::optional<double> horizon = {};  ///< ends exactly there instead
    int max_samples = 400000;
    std::stop_token stop = {};  ///< checked once every sample; the response then ends, unsettled
};

/// `u` of the nodes is the program's output, held, after its computation delay. `settles` is false if `max_samples`
/// came first, or if y is unbounded. `error_integral_final` is the integral when y has come to rest; only with integral
/// action, and not if u rests at a limit. There are no errors: the response of an unstable loop grows until it ends.
StepResponse simulate_sampled(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options);

/// The same on a nonlinear plant, whose equations are integrated between the changes of their input
/// (nonlinear/plant_run.h). `settles` is also false if the states leave the domain of the equations. With integral
/// action y comes to rest at r, otherwise wherever it stays.
StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options);

}  // namespace tunewright
