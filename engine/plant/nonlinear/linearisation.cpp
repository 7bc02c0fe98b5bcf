#include "engine/plant/nonlinear/linearisation.h"

#include <span>
#include <string>

#include "engine/number_text.h"
#include "engine/plant/nonlinear/lie_derivatives.h"

namespace tunewright {

Expected<LinearPlant> linearised_plant(const NonlinearSystem& system) {
    auto linear = LinearPlant::make(system.linearised());
    if (linear) return linear;
    const auto degree = relative_degree(system);
    if (!degree && degree.error().where == "plant/output") return degree.error();
    return Error{linear.error().kind, "plant/equations",
                 "The linearisation at the operating point is not supported. " + linear.error().message};
}

OperatingPoint operating_point(const NonlinearSystem& system) {
    OperatingPoint point{system.description().states, system.u_nominal(), system.y_steady(), system.linearised()};
    for (std::size_t i = 0; i < point.states.size(); ++i) point.states[i].value = system.x_steady()[i];
    return point;
}

namespace {

std::string coefficient(double x) { return "(" + exact_text(x) + ")"; }

std::string state(int i) { return "x" + std::to_string(i + 1); }

// "(0.5)*x1 + (-2)*x3"; empty if every coefficient is 0.
std::string weighted_states(std::span<const double> row) {
    std::string result;
    for (std::size_t i = 0; i < row.size(); ++i)
        if (row[i] != 0)
            result += (result.empty() ? "" : " + ") + coefficient(row[i]) + "*" + state(static_cast<int>(i));
    return result;
}

}  // namespace

Expected<NonlinearSystem> as_equations(const LinearPlant& plant) {
    const Realisation& realisation = plant.realisation();
    const auto n = static_cast<std::size_t>(realisation.n);
    if (realisation.D != 0 || n == 0)
        return Error{ErrorKind::unsupported, "plant",
                     "The plant has a direct term: its output jumps with its input. This method needs a plant whose "
                     "output depends only on its states; add the lag of the actuator or of the sensor."};
    NonlinearPlant written{.states = {},
                           .parameters = {},
                           .equations = {},
                           .input = {.name = "u", .nominal = 0},
                           .output = weighted_states(realisation.C),
                           .L = plant.dead_time()};
    for (std::size_t i = 0; i < n; ++i) {
        std::string rate = weighted_states(std::span(realisation.A).subspan(i * n, n));
        if (realisation.B[i] != 0) rate += (rate.empty() ? "" : " + ") + coefficient(realisation.B[i]) + "*u";
        written.states.push_back({state(static_cast<int>(i)), 0});
        written.equations.push_back({state(static_cast<int>(i)), rate.empty() ? "0" : rate});
    }
    return NonlinearSystem::make(written);
}

}  // namespace tunewright
