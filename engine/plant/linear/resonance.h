// Whether a plant oscillates by itself, so that a search for its best controller may meet several local minima.
#pragma once

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// True if a pair of poles has a damping below 0.4.
bool is_resonant(const LinearPlant& plant);

}  // namespace tunewright
