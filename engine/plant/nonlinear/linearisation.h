// A nonlinear plant as linear methods see it, and a linear plant as nonlinear methods see it.
#pragma once

#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// The linearisation about the steady state. Errors, in words of the equations: the input cannot move the output there,
/// with the reason that the relative degree gives; as LinearPlant::make, `where` = "plant/equations".
Expected<LinearPlant> linearised_plant(const NonlinearSystem& system);

/// Where a nonlinear plant rests, and what it looks like from there.
struct OperatingPoint {
    std::vector<NamedValue> states;  ///< the true steady state nearest to the values given; absolute
    double u = 0;                    ///< the nominal input
    double y = 0;                    ///< the output there, absolute
    StateSpace linear_model;         ///< the linearisation there, with the dead time
};

/// That of the nominal input, as NonlinearSystem found it: nothing is computed anew.
OperatingPoint operating_point(const NonlinearSystem& system);

/// x1, x2, ... of the plant's realisation, with operating point, input u and output 0, and the plant's dead time.
/// Errors: unsupported for a plant with a direct term from u to y, or of more than 20 states.
Expected<NonlinearSystem> as_equations(const LinearPlant& plant);

}  // namespace tunewright
