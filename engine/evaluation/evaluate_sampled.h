// The evaluation of a loop as it is built: the controller computes once every sample time, with its own rules, and is
// judged on the samples over frequency and on the continuous y over time.
#pragma once

#include <optional>

#include "engine/controller/sampled/pid_program.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// What is known of a loop as it is built.
struct DeviceLoop {
    Robustness robustness;  ///< of the samples (loop/sampled/sampled_loop.h); of a nonlinear plant its linearisation's
    Performance performance;
    std::optional<Responses> responses;  ///< with points > 0 and a stable loop
    std::vector<Warning> warnings;
};

/// Steps, horizon, traces and actuator limits as `options` say; noise figures are not computed. With a resolution or a
/// dead band the loop need not come to rest: without a horizon its indices end where the same loop without them has
/// settled. Error: unsupported for a plant that is known at points of its frequency response alone, which says nothing
/// of what lies above pi/Ts; cancelled.
Expected<DeviceLoop> evaluate_sampled(const AnalysedPlant& subject, const SampledPid& law, const ProgramLimits& limits,
                                      const EvaluateOptions& options);

}  // namespace tunewright
