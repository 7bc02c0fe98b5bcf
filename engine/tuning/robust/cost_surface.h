// The cost over the (Ti, Td) plane, from `robust` with "surface": true.
#pragma once

#include <optional>
#include <vector>

#include "engine/tuning/method/report.h"

namespace tunewright {

/// The least cost over Kp; cost[i][j] belongs to Ti[i] (time) and Td[j] (time). Empty: no Kp keeps the limits.
struct CostSurface : MethodReport {
    std::vector<double> Ti, Td;
    std::vector<std::vector<std::optional<double>>> cost;
};

}  // namespace tunewright
