// A coarse look over the (Ti, Td) plane: where a feasible, stable gain exists, and where the cost is low.
#pragma once

#include <vector>

#include "engine/tuning/robust/sweep.h"

namespace tunewright::robust {

struct ScanPoint {
    DesignPoint x{};
    double log_ie = 0;  ///< ln(Ti/|Kp|), a lower bound of ln(load IAE)
};

/// The gains at the ends of the gaps (feasible, stable, largest first) for one (Ti, Td).
std::vector<double> feasible_gains(const Sweep& sweep, double Ti, double Td);

/// The points looked at, spaced evenly in logarithms; times in 1/reference frequency. The default box holds what
/// optimal designs of lag-dominant to dead-time-dominant plants use.
struct ScanBox {
    int Ti_points = 9, Td_points = 7;
    double Ti_low = 0.2, Ti_high = 60;
    double Td_low = 0.02, Td_high = 8;
};

/// The feasible points of the box with their largest gain, ascending in `log_ie`. Empty: no point of it is feasible.
std::vector<ScanPoint> scan(const Sweep& sweep, const ScanBox& box = {});

}  // namespace tunewright::robust
