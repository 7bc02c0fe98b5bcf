// The best design so far, with the figures that progress carries.
#pragma once

#include <optional>

#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"

namespace tunewright::emulation {

/// On the linearisation, for a unit load. Empty where that loop is not stable.
std::optional<BestSoFar> best_so_far(const LinearPlant& plant, const Pid& pid);

}  // namespace tunewright::emulation
