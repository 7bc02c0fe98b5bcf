// The reasons why a relay does not oscillate with a plant, as messages with the field and the cure.
#pragma once

#include <optional>

#include "engine/error.h"
#include "engine/simulation/relay/relay_run.h"

namespace tunewright {

/// A run that has ended without a further switch. y is the relay's input.
struct EndedRun {
    const LinearPlant& plant;
    RelayLevels levels;
    double direction = 1;
    RelayEnd end = RelayEnd::latched;
    double u = 0, y = 0;
};

/// invalid_argument at the setting that causes it (`relay/hysteresis`, `relay/u_plus`, `relay/u_minus`), with a value
/// that works if it is known; unsupported at `plant` or `plant/L` if no setting helps, or if the allowed number of
/// steps was reached.
Error no_oscillation(const EndedRun& run);

/// For a run whose switches still do not repeat after `cycles` cycles: unsupported at `plant`, with the likely cause.
Error no_steady_cycle(const LinearPlant& plant, int cycles);

/// Without dead time and hysteresis, and with a pole excess of at most 2 whose leading coefficient has the feedback's
/// sign, the switches accumulate and there is no oscillation. Then invalid_argument at `relay/hysteresis`; else empty.
/// `direction` is that of the relay, 1 or -1 (relay_direction).
std::optional<Error> switches_without_end(const LinearPlant& plant, const RelayLevels& levels, double direction);

}  // namespace tunewright
