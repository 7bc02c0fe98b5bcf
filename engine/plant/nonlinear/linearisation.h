// Conversions between nonlinear and linear plants: the linearisation, and a linear plant as equations.
#pragma once

#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// The linearisation about the steady state. Errors: the input cannot move the output there, with the reason from the
/// relative degree; those of LinearPlant::make, `where` = "plant/equations".
Expected<LinearPlant> linearised_plant(const NonlinearSystem& system);

/// A nonlinear plant's steady state, with the linearisation there.
struct OperatingPoint {
    std::vector<NamedValue> states;  ///< the exact steady state nearest to the given values; absolute
    double u = 0;                    ///< the nominal input
    double y = 0;                    ///< the output there, absolute
    StateSpace linear_model;         ///< the linearisation there, with the dead time
};

/// The steady state of the nominal input, as NonlinearSystem found it; no new search.
OperatingPoint operating_point(const NonlinearSystem& system);

/// Equations in the states x1, x2, ... of the plant's realisation, with operating point, input
/// u and output 0, and the plant's dead time. Errors: unsupported for a plant with a direct term from u to y, or of
/// more than 20 states.
Expected<NonlinearSystem> as_equations(const LinearPlant& plant);

}  // namespace tunewright
