// One loop of a structure by the method robust, and plants by their factors.
#pragma once

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/rule.h"

namespace tunewright::structure {

/// Kind and limits of one loop's design.
struct LoopDesign {
    ControllerKind controller = ControllerKind::PI;
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;
};

/// The least IAE of a load step within the limits. Errors: those of the method robust.
Expected<IdealPid> robust_settings(const LinearPlant& plant, const LoopDesign& design, const RunControl& control);

/// Gain, zeros, poles and dead time of the plant, integrators included.
Zpk factors_of(const LinearPlant& plant);

/// The plant times s^n, n at most the number of its integrators.
LinearPlant times_s(const LinearPlant& plant, int n);

/// The product of two plants, without cancellation.
Zpk factors_of(const LinearPlant& first, const LinearPlant& second);

}  // namespace tunewright::structure
