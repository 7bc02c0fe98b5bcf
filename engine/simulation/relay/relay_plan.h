// The relay test worth making on a plant: levels, hysteresis, cycles, record.
#pragma once

#include "engine/simulation/relay/relay.h"
#include "engine/simulation/relay/relay_cycle.h"

namespace tunewright {

/// With noise: a hysteresis of 3 noise_std, which a single white sample exceeds by chance once in 741, and levels,
/// raised in their proportion where needed, that swing y over 3 hystereses to either side; 10 steady cycles for
/// averaging (the error falls with the root of their number). Without: levels and hysteresis as given and 3 steady
/// cycles. Rows 1, 2 or 5 times a power of ten apart, at least 200 a period, or as many whole samples of a sampled
/// relay. `steady` is the cycle of the settings as given.
RelayPlan plan_relay(const LinearPlant& plant, const RelaySettings& settings, const SteadyRelayCycle& steady,
                     const RunControl& control);

/// The largest of 1, 2, 5 times a power of ten that is at most x > 0.
double round_down(double x);

}  // namespace tunewright
