// The proportional gain at which a loop oscillates.
#pragma once

#include <optional>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// A gain and the period at which the loop oscillates with it.
struct UltimatePoint {
    double Ku = 0;  ///< of the sign of the feedback that oscillates
    double Pu = 0;
};

/// The P gain at which the loop loses stability when it is raised (in size) from a stable one, and the period of the
/// oscillation: Ziegler and Nichols (1942). Of a plant that is stable or integrating the sign is that of its
/// low-frequency gain. Empty where no gain destabilises, or none stabilises.
std::optional<UltimatePoint> ultimate_point(const LinearPlant& plant);

}  // namespace tunewright
