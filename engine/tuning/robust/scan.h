// A coarse look over the (Ti, Td) plane: where a feasible, stable gain exists, and where the cost is low.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/tuning/robust/sweep.h"

namespace tunewright::robust {

struct ScanPoint {
    Point x{};
    double log_ie = 0;  ///< ln(Ti/|Kp|), a lower bound of ln(load IAE)
};

/// The gains at the ends of the gaps (feasible, stable, largest first) for one (Ti, Td).
std::vector<double> feasible_gains(const Sweep& sweep, double Ti, double Td);

/// The feasible points of the plane with their largest gain, ascending in `log_ie`. Empty: no point of it is feasible.
std::vector<ScanPoint> scan(const Sweep& sweep, int Ti_points = 9, int Td_points = 7);

}  // namespace tunewright::robust
