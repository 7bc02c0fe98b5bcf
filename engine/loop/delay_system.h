// The closed loop in state space: linear equations with one delayed signal.
//
//   x' = F x + G v + H r,   u = M x + N v + R r,   y = Y x + Z v + Y_r r,   v(t) = w(t - L),  w = u + d
//
// Plant states first, then the controller's: filter states, integral of r - y_f, filtered set point. N couples u to the
// delayed signal directly for proportional action on a plant with a direct term, or a pure derivative on a plant of
// pole excess one: a neutral loop.
#pragma once

#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

struct DelaySystem {
    int n = 0;
    double L = 0;
    std::vector<double> F;        // n x n, row by row
    std::vector<double> G, H, M;  // n
    std::vector<double> Y;        // n
    double N = 0, R = 0, Z = 0;
    double Y_r = 0;           // direct term from r to y, for a loop that is closed without delay
    int integral_state = -1;  // index of the integral's state, -1 without integral action
    int setpoint_state = -1;  // index of the filtered set point, the last state; -1 without a set-point filter
    double setpoint_lag = 0;  // its T
};

/// The loop must be well posed (accepted by Loop::make). Set-point weights are included; a derivative of r needs the
/// `derivative` filter.
DelaySystem make_delay_system(const LinearPlant& plant, const ParallelPid& controller);

/// The same for L = 0 with the algebraic loop v = u + d solved: v then consists of d alone.
DelaySystem close_without_delay(const DelaySystem& open);

}  // namespace tunewright
