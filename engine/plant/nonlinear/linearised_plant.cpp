#include "engine/plant/nonlinear/linearised_plant.h"

#include "engine/plant/nonlinear/lie_derivatives.h"

namespace tunewright {

Expected<LinearPlant> linearised_plant(const NonlinearSystem& system) {
    auto linear = LinearPlant::make(system.linearised());
    if (linear) return linear;
    const auto degree = relative_degree(system);
    if (!degree && degree.error().where == "plant/output") return degree.error();
    return Error{linear.error().kind, "plant/equations",
                 "The linearisation at the operating point cannot be worked with. " + linear.error().message};
}

}  // namespace tunewright
