// The open-loop unit step response of a linear plant, exact at every sample.
#pragma once

#include <vector>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// The response to v = 1 for t > 0, x(0) = 0, at one time. The dead time is not included: add it to t.
struct StepSample {
    double t = 0;
    std::vector<double> x;  ///< state of the plant's realisation
    double y = 0;
    double slope = 0;      ///< dy/dt
    double curvature = 0;  ///< d2y/dt2
};

/// Samples from t = 0+ until every decaying mode is below 1e-6 of its initial value, at most 20,000. The spacing is a
/// tenth of the shortest time constant or radian of the modes that have not decayed, and otherwise grows with t: a
/// plant with lags of 1 ms and 1 h needs some hundreds. Each sample is propagated by matrix exponentials: no
/// discretisation error.
///
/// The first sample is the direct term, at t = 0+. It is the only one if no mode decays (static, purely integrating and
/// purely unstable plants). y is the plant's output for an input of 1, in units of y per unit of u.
std::vector<StepSample> step_response(const LinearPlant& plant);

/// The same response `tau` >= 0 after `from`, exact for any `tau`. `realisation` is that of the same plant as `from`.
/// Cost: one matrix exponential of order n + 1.
StepSample step_response_after(const Realisation& realisation, const StepSample& from, double tau);

}  // namespace tunewright
