// The evaluation of an implemented loop: the controller computes once every sample time, with its own rules. Robustness
// is that of the samples, performance that of the continuous y.
#pragma once

#include <optional>

#include "engine/controller/sampled/pid_program.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// The figures of an implemented loop.
struct DeviceLoop {
    Robustness robustness;  ///< of the samples (sampled_loop.h); for a nonlinear plant of its linearisation
    Performance performance;
    std::optional<Responses> responses;   ///< with points > 0 and a stable loop
    std::optional<RegionFigures> region;  ///< for a family of more than one plant
};

/// `options` give steps, horizon, traces and actuator limits; noise figures are not computed. With a resolution or a
/// dead band the loop may never come to rest: without a horizon its indices end where the same loop without them has
/// settled. Errors: unsupported for a plant that is known only by points of its frequency response, whose response
/// above pi/Ts is unknown; cancelled.
Expected<DeviceLoop> evaluate_sampled(const AnalysedPlant& subject, const SampledPid& law, const ProgramLimits& limits,
                                      const EvaluateOptions& options);

/// False: resolutions or a dead band keep the loop moving, so that a simulation needs an end of its own.
bool comes_to_rest(const ProgramLimits& limits);

}  // namespace tunewright
