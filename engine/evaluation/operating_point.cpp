#include "engine/evaluation/operating_point.h"

namespace tunewright {

OperatingPoint operating_point(const NonlinearSystem& system) {
    OperatingPoint point{system.description().states, system.u_nominal(), system.y_steady(), system.linearised()};
    for (std::size_t i = 0; i < point.states.size(); ++i) point.states[i].value = system.x_steady()[i];
    return point;
}

}  // namespace tunewright
