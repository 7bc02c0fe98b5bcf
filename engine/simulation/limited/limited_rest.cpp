#include "engine/simulation/limited/limited_rest.h"

#include <algorithm>
#include <cmath>

namespace tunewright {

LimitedRest find_rest(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                      const ActuatorLimits& limits) {
    LimitedRest rest;
    rest.linear = steady_state(plant, controller, in);
    if (!rest.linear.exists) return rest;
    const double u = rest.linear.u, slack = 1e-9 * std::abs(u);
    if (u <= limits.max + slack && u >= limits.min - slack) {
        rest.exists = rest.within = true;
        rest.y = rest.linear.y;
        rest.u = std::clamp(u, limits.min, limits.max);
        return rest;
    }
    if (plant.integrators() > 0 || plant.unstable_poles() > 0) return rest;
    rest.exists = true;
    rest.u = u > limits.max ? limits.max : limits.min;
    rest.y = plant.integrators() < 0 ? 0 : plant.low_frequency_gain() * (rest.u + in.d);
    return rest;
}

double scale_of_y(const LinearPlant& plant, const StepInputs& in, const ActuatorLimits& limits, double y_rest) {
    const double time = plant.time_scale();
    double u = std::abs(in.d);
    for (const double limit : {limits.min, limits.max})
        if (std::isfinite(limit)) u += std::abs(limit);
    const double gain = std::abs(plant.rational({0, time > 0 ? 1 / time : 1}));
    return std::max({std::abs(in.r), std::abs(y_rest), gain * u, 1e-200});
}

}  // namespace tunewright
