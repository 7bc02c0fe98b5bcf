// The response of a linear loop to inputs that change while it runs: a set point that jumps or rises in a straight
// line, then a load at the plant's input or output as a step, a pulse or a ramp; limits of u, dead time exact.
//
//                                      d                 q
//   r(t), y --> [ controller ] -- u --(+)--> [ P ] -----(+)--> y
//
// Each input is a pair of states of the loop (its value and its slope) that the plant's input does not reach and that
// jump at known times: value' = slope, slope' = 0. A load d at the plant's input arrives after the dead time, so its
// states jump that much later. Between jumps the loop is a linear system with one delayed signal, which the methods of
// limited/limited_response.h and sampled/sampled_response.h solve; they lose no accuracy to the shape of an input.
//
// Units: t in the plant's time; y, r, q in units of y; u, d in units of u; all deviations from the rest before t = 0.
#pragma once

#include <optional>

#include "engine/controller/pid.h"
#include "engine/controller/sampled/pid_program.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {

enum class LoadShape {
    step,   ///< `size` from the start on
    pulse,  ///< `size` for the duration, then 0
    ramp,   ///< from 0 to `size` in a straight line over the duration, then `size`
};

struct CourseLoad {
    double size = 0;  ///< != 0
    bool at_output = false;
    LoadShape shape = LoadShape::step;
    double duration = 0;  ///< > 0 for a pulse and a ramp, else not used
    double start = 0;     ///< >= 0
};

struct Course {
    double r = 0;          ///< final set point
    double ramp_time = 0;  ///< >= 0: the set point rises from 0 to r in this time, in a straight line
    std::optional<CourseLoad> load;
};

/// The set point at t >= 0.
double setpoint_at(const Course& course, double t);

/// The time of the last change of an input; a load at the plant's input arrives one dead time later.
double last_change(const Course& course);

/// As simulate_limited: u of the nodes is the limited output, `y` contains q. The nodes include the times at which an
/// input changes. `settles` refers to the rest after the last change. Infinite limits do not limit.
StepResponse simulate_course(const LinearPlant& plant, const ParallelPid& controller, const Course& course,
                             const ActuatorLimits& limits, const ResponseOptions& options);

/// As simulate_sampled, with the same nodes. The program reads the set point at its samples.
StepResponse simulate_course(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                             const Course& course, const SampledOptions& options);

}  // namespace tunewright
