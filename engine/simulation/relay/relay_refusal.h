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

/// invalid_argument at the setting that is to blame (`relay/hysteresis`, `relay/u_plus`, `relay/u_minus`), with the
/// value that would do where it is known; unsupported at `plant` or `plant/L` where no setting helps, and where the
/// work allowed was not enough.
Error no_oscillation(const EndedRun& run);

/// After `cycles` cycles the switches still do not repeat: unsupported at `plant`, with the likely cause.
Error no_steady_cycle(const LinearPlant& plant, int cycles);

/// Without dead time and hysteresis, and with a pole excess of at most 2 whose leading coefficient has the feedback's
/// sign, the switches accumulate: there is no oscillation to wait for. Then invalid_argument at `relay/hysteresis`;
/// else empty. `direction` is that of the relay, 1 or -1 (relay_direction).
std::optional<Error> switches_without_end(const LinearPlant& plant, const RelayLevels& levels, double direction);

}  // namespace tunewright
