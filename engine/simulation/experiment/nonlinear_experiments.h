// Simulated step and relay tests on a nonlinear plant: identification reads their records like measured ones.
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/progress.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright {

struct StepTest {
    std::vector<double> t, u, y;  ///< deviations; u[i] holds from t[i]; t[0] < 0: the first rows are at rest
    double du = 0;                ///< the step of u at t = 0
    bool settled = true;
};

/// From the operating point until y has settled (integrating and unstable plants: until it has moved enough): some
/// thousand exact rows at equal distances. `du` is limited to the input's limits. Errors: unsupported if the states
/// leave the model's domain or y does not move; cancelled.
Expected<StepTest> simulate_step_test(const NonlinearSystem& system, double du, const RunControl& control);

/// From the operating point until periods and swings repeat to 1e-6, at least six: some thousand rows at equal
/// distances and at every switch. The relay switches at the time of crossing; amplitude and hysteresis are deviations
/// (relay.h). Errors: unsupported if there is no oscillation (without dead time a hysteresis is needed; if y reverses
/// at once at it there is no Ku) or if the states leave the model's domain; cancelled.
struct NonlinearRelayTest {
    RelayRecord record;
    double Pu = 0,
           Ku = 0;  ///< of the last period; Ku = 4 d/(pi sqrt(a^2 - hysteresis^2)) (Åström & Hägglund 1984), > 0
    bool reversed = false;  ///< the relay acts on -y: the plant's gain is negative
};
Expected<NonlinearRelayTest> simulate_relay_test(const NonlinearSystem& system, double amplitude, double hysteresis,
                                                 const RunControl& control);

}  // namespace tunewright
