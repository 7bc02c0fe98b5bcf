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
///
/// It stands here because a node that a call returns is copied from memory that has just been written number by number:
/// that costs a response a tenth.
inline ResponseNode node_at(const ResponseSystem& system, double t, const std::vector<double>& x, Signal v) {
    const DelaySystem& s = system.s;
    if (!system.delayed) v = {system.in.d, 0};
    double u = s.N * v.value + s.R * system.in.r, u_slope = system.MG * v.value + system.MH + s.N * v.slope;
    double y = s.Z * v.value + s.Y_r * system.in.r, y_slope = system.YG * v.value + system.YH + s.Z * v.slope;
    // One loop: with four calls of dot() a whole response takes 3 to 4 % longer.
    const auto n = static_cast<std::size_t>(s.n);
    for (std::size_t i = 0; i < n; ++i) {
        u += s.M[i] * x[i];
        u_slope += system.MF[i] * x[i];
        y += s.Y[i] * x[i];
        y_slope += system.YF[i] * x[i];
    }
    return {.t = t, .y = y, .y_slope = y_slope, .u = u, .u_slope = u_slope, .error_integral = -x[n]};
}

}  // namespace tunewright
