// A coarse look over the (Ti, Td) plane: where a feasible, stable gain exists, and where the cost is low.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/tuning/robust/sweep.h"

namespace tunewright::robust {

struct ScanOptions {
    int Ti_points = 9;
    int Td_points = 7;
    double simulation_tolerance = 1e-3;
    bool cost = true;  ///< false: the least ln(Ti/Kp) decides, nothing is simulated
};

struct ScanPoint {
    Point x{};
    double log_cost = 0;
};

/// The gains at the ends of the gaps (feasible, stable, largest first) for one (Ti, Td).
std::vector<double> feasible_gains(const Sweep& sweep, double Ti, double Td);

/// The best point of the scan, or empty if no point of it is feasible. Points whose lower bound IAE >= Ti/Kp already
/// exceeds the best cost are not simulated.
std::optional<ScanPoint> scan(const Sweep& sweep, const ScanOptions& options);

}  // namespace tunewright::robust
