// A sampled loop whose inputs change while it runs. sampled_response.cpp has the run.
//
// The program reads set point and y once every sample time; the loads move the plant in continuous time, exactly, as
// states that the plant's own input does not reach.
#pragma once

#include <functional>
#include <vector>

#include "engine/simulation/limited/limited_course.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {

/// Inputs that change while the loop runs (course/course.h). A jump at the time of a sample comes after it.
struct SampledCourse {
    Realisation plant;                       ///< with the loads as further states, at rest at 0 until they jump
    std::vector<StateJump> jumps;            ///< in ascending t
    std::function<double(double)> setpoint;  ///< at the time of a sample
    SteadyState rest;                        ///< after all changes, within the limits
    StepInputs largest;                      ///< the sizes of the inputs
    double last_change = 0;                  ///< without a horizon the response ends at rest after this time
};

/// As simulate_sampled, with such inputs. With a horizon, changes after it have no effect.
///
/// The nodes include the time of every jump: y and its slope before and after it.
/// The error's integrals of the nodes are those of -y.
StepResponse simulate_sampled_course(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                                     const SampledCourse& course, const SampledOptions& options);

}  // namespace tunewright
