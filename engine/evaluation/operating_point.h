// Where a nonlinear plant rests, and its linearisation there.
#pragma once

#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

struct OperatingPoint {
    std::vector<NamedValue> states;  ///< the true steady state nearest to the values given; absolute
    double u = 0;                    ///< the nominal input
    double y = 0;
    StateSpace linear_model;  ///< the linearisation there, with the dead time
};

OperatingPoint operating_point(const NonlinearSystem& system);

}  // namespace tunewright
