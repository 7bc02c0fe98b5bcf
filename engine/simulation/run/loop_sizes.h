// Sizes of y and u in a loop after a step, each in its own unit: the reference of "grows without bound".
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The plant's dead time and lags; for a plant without either the time in which the controller moves it. > 0.
inline double own_time(const LinearPlant& plant, const ParallelPid& controller) {
    if (const double time = plant.time_scale(); time > 0) return time;
    const double gain = std::abs(plant.gain()), n = std::max(plant.integrators(), 0);
    if (n > 0 && controller.Kp != 0) return std::pow(gain * std::abs(controller.Kp), -1 / n);
    if (controller.Ki != 0) return std::pow(gain * std::abs(controller.Ki), -1 / (n + 1));
    return 1;  // nothing depends on time
}

/// |P| at 1/own_time: the change of y over that time for u = 1.
inline double own_gain(const LinearPlant& plant, const ParallelPid& controller) {
    return std::abs(plant.rational({0, 1 / own_time(plant, controller)}));
}

struct LoopSizes {
    double y = 0, u = 0;
};

/// Sizes of a loop whose plant moves by `gain` for u = 1. The response of u to r has the size of its proportional part,
/// or of the u that r needs; the response of y to u has the size of the plant's gain, or of the y that makes the
/// proportional part as large: |P S| <= Mt/|Kp|.
inline LoopSizes loop_sizes(double gain, const ParallelPid& controller, const StepInputs& inputs) {
    const double Kp = std::abs(controller.Kp), r = std::abs(inputs.r);
    const double u = std::max({std::abs(inputs.d), Kp * r, gain > 0 ? r / gain : 0});
    return {std::max({r, gain * u, Kp > 0 ? u / Kp : 0}), u};
}

}  // namespace tunewright
