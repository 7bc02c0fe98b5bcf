// Why a relay does not oscillate with a plant, in sentences that name the field and the cure.
#pragma once

#include <optional>

#include "engine/error.h"
#include "engine/simulation/relay/relay_run.h"

namespace tunewright {

/// A run that has ended without a further switch. y as the relay sees it.
struct EndedRun {
    const LinearPlant& plant;
    RelayLevels levels;
    double direction = 1;
    RelayEnd end = RelayEnd::latched;
    double u = 0, y = 0;
};

Error no_oscillation(const EndedRun& run);

/// After `cycles` cycles the switches still do not repeat.
Error no_steady_cycle(const LinearPlant& plant, int cycles);

/// Without dead time and hysteresis, and with a pole excess of at most 2 whose leading coefficient has the feedback's
/// sign, the switches accumulate: there is no oscillation to wait for.
std::optional<Error> switches_without_end(const LinearPlant& plant, const RelayLevels& levels, double direction);

}  // namespace tunewright
