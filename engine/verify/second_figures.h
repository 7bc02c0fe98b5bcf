// All figures of one linear loop by the second way, for comparison with an evaluation.
#pragma once

#include <string>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/verify/frequency_scan.h"

namespace tunewright::verify {

/// A part of an evaluation without a second way.
struct Unverified {
    std::string part;  ///< "robustness", "performance", "performance/setpoint", ...
    std::string why;
};

struct SecondFigures {
    Robustness robustness;
    Performance performance;
    std::vector<Unverified> unverified;  ///< parts whose figures above have no meaning
    bool lacks(const std::string& part) const;
};

/// Figures of the loop; `options` give steps, horizon, actuator limits and noise. A response in which u reaches a limit
/// of the actuator has no second way.
SecondFigures second_figures(const LinearPlant& plant, const ParallelPid& pid, const EvaluateOptions& options,
                             const GivenPeaks& given = {});

}  // namespace tunewright::verify
