// One loop of a structure by the method robust, and plants by their factors.
#pragma once

#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/rule.h"

namespace tunewright {
class BlockDiagram;
}

namespace tunewright::structure {

/// Kind and limits of one loop's design.
struct LoopDesign {
    ControllerKind controller = ControllerKind::PI;
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;
};

/// The least IAE of a load step within the limits. Errors: those of the method robust, at "plant" or "tune"; none names
/// an option that a LoopDesign does not have.
Expected<IdealPid> robust_settings(const LinearPlant& plant, const LoopDesign& design, const RunControl& control);

/// Gain, zeros, poles and dead time of the plant, integrators included.
Zpk factors_of(const LinearPlant& plant);

/// The product of two plants, without cancellation.
Zpk factors_of(const LinearPlant& first, const LinearPlant& second);

/// The plant with its gain and its dead time times a factor each.
LinearPlant changed(const LinearPlant& plant, double gain, double dead_time);

/// Plants with the signals that drive them.
using PlantRow = std::vector<std::pair<int, const LinearPlant*>>;

/// Adds plants from several inputs to one output. Integrators that they share stand behind their sum: as one in each
/// they would be modes that no controller moves.
void add_row(BlockDiagram& blocks, const PlantRow& row, int y);

}  // namespace tunewright::structure
