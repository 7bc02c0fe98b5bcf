// The equations that a response is stepped with: the delay system, the integral of y - r and the constant inputs.
#pragma once

#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The delay system with one more state, the integral of y - r, and without the constant inputs: x' = F x + G v + b,
/// row by row, for n states x and the delayed signal v.
struct ResponseSystem {
    DelaySystem s;
    int n = 0;
    std::vector<double> F, G, b;
    // u' = MF x + MG v + N v' + MH, y' = YF x + YG v + Z v' + YH.
    std::vector<double> MF, YF;
    double MG = 0, YG = 0, MH = 0, YH = 0;
    StepInputs in;
    bool delayed = false;
};

/// Without a dead time the loop is closed: v is the load alone.
ResponseSystem make_response_system(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in);

/// Measurement and controller output at states x and delayed signal v (not used without dead time).
ResponseNode node_at(const ResponseSystem& system, double t, const std::vector<double>& x, Signal v);

}  // namespace tunewright
