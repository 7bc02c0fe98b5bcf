// The equations that a response is stepped with (the delay system, the integral of y - r and the constant inputs), and
// the times that its steps are measured by.
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

/// The largest |p| of the plant's poles, of the measurement or derivative filter and, without a dead time, of the
/// closed loop; 1/time. 0: nothing moves by itself.
double fastest_rate(const ResponseSystem& system, const LinearPlant& plant, const ParallelPid& controller);

/// The step that a run starts with: a quarter of the time 1/`fastest`, with a dead time at most an eighth of it;
/// infinite where neither limits it.
double first_step(const ResponseSystem& system, double fastest);

/// The plant's own time: its dead time plus 1/|p| of its poles except those at 0 (LinearPlant::time_scale), in the
/// plant's unit. 1 where it has neither, so that it can be divided by.
double own_time(const LinearPlant& plant);

/// Measurement and controller output at states x and delayed signal v (not used without dead time).
ResponseNode node_at(const ResponseSystem& system, double t, const std::vector<double>& x, Signal v);

}  // namespace tunewright
