// Where a PID loop on a nonlinear plant comes to rest.
#pragma once

#include <optional>
#include <vector>

#include "engine/simulation/nonlinear/nonlinear_loop.h"

namespace tunewright {

struct NonlinearRest {
    bool within = false;    ///< by the control law; false: at a limit
    double y = 0, u = 0;    ///< deviations
    std::vector<double> x;  ///< absolute
};

/// The rest nearest to these states, by Newton's method: under the control law if the limits admit it, else at the
/// limit. Empty where none is found near. `sizes`: by how much the states, and last u, move in this loop; what is far
/// below them is rounding.
std::optional<NonlinearRest> find_rest(const NonlinearLoop& loop, const StepInputs& inputs, std::vector<double> x,
                                       double u, const std::vector<double>& sizes);

}  // namespace tunewright
