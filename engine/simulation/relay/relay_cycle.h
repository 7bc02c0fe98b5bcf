// The steady oscillation of a relay and a linear plant, as a fixed point of the switching map.
#pragma once

#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/simulation/relay/relay_run.h"

namespace tunewright {

/// u is u_plus for t_plus, then u_minus for t_minus, periodically.
struct SteadyRelayCycle {
    double direction = 1;  ///< -1: the relay acts on -y (reversed)
    double t_plus = 0, t_minus = 0;
    double y_max = 0, y_min = 0;  ///< of the plant's own y
    std::vector<double> x;        ///< state of the realisation when u_plus reaches it
    int settling_cycles = 0;      ///< cycles of a run from rest before the first that is steady to 1e-3 of Pu

    double Pu() const { return t_plus + t_minus; }
};

/// The direction in which a relay's feedback is negative: the sign of Kp of a stabilising P controller, -1 or 1. It is
/// the sign of the low-frequency gain, reversed once by every unstable pole.
double relay_direction(const LinearPlant& plant);

/// A run from rest gives the starting values; Newton's method on (x, t_plus, t_minus) with x the state when u_plus
/// reaches the rational part: x after one period is x again, and y is on the threshold where the relay switches. Both
/// are exact for any dead time, even of many periods. The result is simulated for a period and must switch at the
/// computed times (1e-8 Pu); the run from rest must have come near it. If the plant has unstable poles and the relay of
/// `relay_direction` finds no cycle, the other direction is tried too.
///
/// Errors: invalid_argument (`relay/...`) for levels and hysteresis with which the relay cannot oscillate, unsupported
/// (`plant`) for plants that no relay makes oscillate steadily; cancelled.
Expected<SteadyRelayCycle> steady_relay_cycle(const LinearPlant& plant, const RelayLevels& levels,
                                              const RunControl& control);

/// The phase of the steady cycle at t = 0, when the relay switches to u_plus.
RelayState state_at_switch(RelayMotion& motion, double dead_time, const RelayLevels& levels,
                           const SteadyRelayCycle& cycle);

}  // namespace tunewright
